#include <iostream>
#include <memory>

#include "commands/command.h"
#include "text/error.h"

namespace mssim {

std::function<int()> declare_help(Arguments& arguments) {
  const auto name = std::make_shared<std::string>();
  arguments.add("COMMAND", *name, "Command to explain (default: all, with one line each)");
  return [name, arguments] {
    const std::string page = arguments.help_page(*name);
    if (page.empty()) throw UsageError(unknown_command(*name));
    std::cout << page;
    return exit_ok;
  };
}

}  // namespace mssim
