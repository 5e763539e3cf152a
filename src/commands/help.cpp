#include <iostream>
#include <memory>

#include "commands/command.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

std::function<int()> declare_help(Arguments& arguments) {
  const auto name = std::make_shared<std::string>();
  const auto manual = std::make_shared<bool>(false);
  const Argument command =
      arguments.add("COMMAND", *name, "Command to explain (default: all, with one line each)").offers([] {
        return mapped<std::string>(commands(), &Command::name);
      });
  arguments.add_flag("--manual", *manual, "Print all pages as one manual page, for man").excludes(command);
  return [name, manual, arguments] {
    if (*manual) {
      std::cout << arguments.manual_page();
      return exit_ok;
    }
    const std::string page = arguments.help_page(*name);
    if (page.empty()) throw UsageError(unknown_command(*name));
    std::cout << page;
    return exit_ok;
  };
}

}  // namespace mssim
