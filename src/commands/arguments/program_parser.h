#pragma once

#include <functional>
#include <memory>
#include <span>
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

  /// What may stand in the place of the last of `words`, the beginning of a command line without the program.
  /// On the first line: `file` or `directory` if the name of one may, else `words`; then a tab and what a
  /// name follows in that word ("--scene=cloth2500,"). Below it, a line for each whole word that begins as
  /// the last one, with a tab and its description if it has one.
  std::string completions(std::span<const std::string> words) const;

 private:
  std::unique_ptr<CLI::App> program_;
  OffersOfOptions offers_;
};

}  // namespace mssim
