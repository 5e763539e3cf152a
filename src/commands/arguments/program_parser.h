#pragma once

#include <functional>
#include <memory>
#include <string>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Says which option a word without one was probably meant for, such as "--scene"; empty where none.
using OptionOfWord = std::function<std::string(const std::string& word)>;

/// Reads the command line of a program with commands: `mssim COMMAND ARGUMENTS`.
class ProgramParser {
 public:
  /// `version` is what --version prints.
  ProgramParser(const std::string& name, const std::string& description, const std::string& version);
  ~ProgramParser();

  /// A command; `end` stands at the end of its help page. Its arguments are to be declared before parsing.
  Arguments add_command(const std::string& name, const std::string& description, const std::string& end);
  /// What stands at the end of the program's help page.
  void end_help_with(const std::string& text);

  /// What a command line asks for; of the three texts at most one is not empty.
  struct Request {
    std::string page;     ///< of --help or --version, to be printed
    std::string refusal;  ///< one sentence on what is wrong with the command line, with the remedy
    std::string command;  ///< name of the command to run; its targets are set
  };
  Request parse(int argc, const char* const* argv, const OptionOfWord& option_of);

  std::string help_page() const;

 private:
  std::unique_ptr<CLI::App> program_;
};

}  // namespace mssim
