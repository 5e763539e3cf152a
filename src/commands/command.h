#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "commands/arguments/arguments.h"

namespace mssim {

/// A row of the TABLE of subcommands. A new one is one row in command.cpp and a file of its own.
struct Command {
  std::string_view name;
  std::string_view description;
  std::string_view example;  ///< shown by `mssim --help` and `mssim COMMAND --help`
  /// Declares its arguments and returns what runs after they have been parsed: it returns an ExitCode.
  std::function<int()> (*declare)(Arguments& arguments);
};

std::span<const Command> commands();

/// Command::declare of each, in the file that is called as the command.
std::function<int()> declare_bench(Arguments& arguments);
std::function<int()> declare_run(Arguments& arguments);
std::function<int()> declare_render(Arguments& arguments);
std::function<int()> declare_export(Arguments& arguments);
std::function<int()> declare_guide(Arguments& arguments);
std::function<int()> declare_check(Arguments& arguments);
std::function<int()> declare_compare(Arguments& arguments);
std::function<int()> declare_report(Arguments& arguments);
std::function<int()> declare_measure(Arguments& arguments);
std::function<int()> declare_new_backend(Arguments& arguments);
std::function<int()> declare_list(Arguments& arguments);
std::function<int()> declare_help(Arguments& arguments);

/// The complaint about a word that is no row's name.
std::string unknown_command(std::string_view name);

/// Runs the whole program. Messages go to stderr, results to stdout. Never throws.
int run_program(int argc, char** argv);

}  // namespace mssim
