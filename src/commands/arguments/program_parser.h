#pragma once

#include <functional>
#include <memory>
#include <string>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Returns the option that probably belongs before a stray word, such as "--scene"; empty if there is none.
using OptionOfWord = std::function<std::string(const std::string& word)>;

/// Reads the command line of a program with commands: `mssim COMMAND ARGUMENTS`.
class ProgramParser {
 public:
  /// `version` is what --version prints.
  ProgramParser(const std::string& name, const std::string& description, const std::string& version);
  ~ProgramParser();

  /// Adds a command; `end` is the end of its help page. Its arguments must be declared before parsing.
  Arguments add_command(const std::string& name, const std::string& description, const std::string& end);
  /// Sets the end of the program's help page.
  void end_help_with(const std::string& text);

  /// The result of parsing; at most one of the three texts is not empty.
  struct Request {
    std::string page;     ///< for --help or --version, to be printed
    std::string refusal;  ///< one sentence about the error in the command line, with a remedy
    std::string command;  ///< name of the command to run; its targets have been set
  };
  Request parse(int argc, const char* const* argv, const OptionOfWord& option_of);

  std::string help_page() const;

 private:
  std::unique_ptr<CLI::App> program_;
};

}  // namespace mssim
