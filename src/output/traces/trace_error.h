#pragma once

#include <string>

#include "text/error.h"

namespace mssim {

/// Thrown for a trace that cannot be read. what() is one sentence that names the file, what is wrong with it
/// and what to do about it. Commands end with exit code 2, and with 4 where the system refused to read.
struct TraceError : Error {
  TraceError(const std::string& sentence, bool refused_by_system)
      : Error(refused_by_system ? exit_file_error : exit_bad_input, sentence) {}
};

}  // namespace mssim
