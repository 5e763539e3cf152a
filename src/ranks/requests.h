#pragma once

#include <map>
#include <string>
#include <string_view>

#include "platform/process.h"

namespace mssim {

/// The program's end of the protocol of own backends (docs/own-backends.md): what mssim says comes line by
/// line.
class Requests {
 public:
  /// Connects to the socket that MSSIM_SOCKET names. Throws std::runtime_error with one sentence.
  Requests();

  /// What is said before "prepare": the first word of each line, and the rest of it. Of lines that begin
  /// alike the last one.
  std::map<std::string, std::string> read_introduction();
  /// The next line, without its newline; "end" where mssim has gone.
  std::string next();
  /// Sends a line, and its newline.
  void answer(std::string_view line);

 private:
  Descriptor socket_;
  std::string received_;
};

/// A sentence as what follows the first word of an answer: in one line.
std::string in_one_line(std::string text);

}  // namespace mssim
