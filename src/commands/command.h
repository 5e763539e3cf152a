#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "commands/arguments/arguments.h"

namespace mssim {

/// A row of the TABLE of subcommands. A new one is a row in command.cpp and a file of its own.
struct Command {
  std::string_view name;
  std::string_view description;
  std::string_view example;  ///< shown by `mssim --help` and `mssim COMMAND --help`
  /// Declares the command's arguments. Returns the function to run after parsing, which returns an ExitCode.
  std::function<int()> (*declare)(Arguments& arguments);
};

/// The TABLE.
std::span<const Command> commands();

/// Command::declare of each command, defined in the file of the command's name.
std::function<int()> declare_bench(Arguments& arguments);
std::function<int()> declare_run(Arguments& arguments);
std::function<int()> declare_render(Arguments& arguments);
std::function<int()> declare_export(Arguments& arguments);
std::function<int()> declare_guide(Arguments& arguments);
std::function<int()> declare_check(Arguments& arguments);
std::function<int()> declare_compare(Arguments& arguments);
std::function<int()> declare_history(Arguments& arguments);
std::function<int()> declare_report(Arguments& arguments);
std::function<int()> declare_table(Arguments& arguments);
std::function<int()> declare_measure(Arguments& arguments);
std::function<int()> declare_web(Arguments& arguments);
std::function<int()> declare_new_backend(Arguments& arguments);
std::function<int()> declare_doctor(Arguments& arguments);
std::function<int()> declare_list(Arguments& arguments);
std::function<int()> declare_help(Arguments& arguments);

/// The error message for an unknown command.
std::string unknown_command(std::string_view name);

/// Runs the whole program. Messages go to stderr, results to stdout. Never throws.
int run_program(int argc, char** argv);

}  // namespace mssim
