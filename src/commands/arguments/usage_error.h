#pragma once

#include <string>

#include "commands/arguments/program_parser.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace mssim {

/// What is wrong with a command line that its parser has refused: one sentence with the option, the value and
/// the remedy, ending with where help is. `app` is the program, which has parsed the command line as far as
/// it could; `option_of` is asked about a word that no option stands before.
std::string usage_sentence(const CLI::ParseError& error, const CLI::App& app, const OptionOfWord& option_of);

}  // namespace mssim
