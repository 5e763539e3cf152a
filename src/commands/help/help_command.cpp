#include "commands/help/help_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands/help/help_page.h"
#include "commands/shared/command.h"
#include "commands/shared/exit_code.h"

namespace mssim {
namespace {

int run(const CLI::App& program, const std::string& name) {
  if (name.empty()) {
    std::cout << help_page(program, "mssim");
    return exit_ok;
  }
  const std::vector<const CLI::App*> named =
      program.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  if (named.empty()) throw UsageError(unknown_command(name));
  std::cout << help_page(*named.front(), "mssim " + name);
  return exit_ok;
}

}  // namespace

std::function<int()> declare_help(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  app.add_option("COMMAND", *name, "Command to explain (default: all of them, in a line each)");
  return [name, program = app.get_parent()] { return run(*program, *name); };
}

}  // namespace mssim
