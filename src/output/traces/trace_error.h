#pragma once

#include <stdexcept>
#include <string>

namespace mssim {

/// Thrown for a trace that cannot be read. what() is one sentence that names the file, what is wrong with it
/// and what to do about it. Commands end with exit code 2, and with 4 where the system refused to read.
struct TraceError : std::runtime_error {
  TraceError(const std::string& sentence, bool refused_by_system)
      : std::runtime_error(sentence), refused(refused_by_system) {}
  bool refused;
};

}  // namespace mssim
