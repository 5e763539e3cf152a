#include "commands/help/help_page.h"

#include <sstream>

namespace mssim {
namespace {

constexpr std::size_t left_column = 26, page_width = 80;

/// `name` on the left, the text on the right in as many lines as it takes.
std::string entry(const std::string& name, const std::string& text) {
  std::string page = "  " + name, line;
  // A name that fills its column has a line of its own.
  if (page.size() + 2 > left_column) page += '\n';
  const auto put = [&] {
    const std::size_t start = page.rfind('\n') + 1;
    page.append(left_column - (page.size() - start), ' ').append(line).append("\n");
    line.clear();
  };
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && left_column + line.size() + 1 + word.size() > page_width) put();
    line.append(line.empty() ? "" : " ").append(word);
  }
  put();
  return page;
}

}  // namespace

std::string HelpPage::make_usage(const CLI::App* app, std::string name) const {
  std::string usage = "\nUsage: " + name;
  for (const CLI::Option* option : app->get_options())
    if (option->get_positional()) usage += ' ' + make_option_usage(option);
  if (!app->get_subcommands({}).empty()) usage += " COMMAND";
  return usage + " [OPTIONS]\n";
}

std::string HelpPage::make_description(const CLI::App* app) const { return app->get_description() + '\n'; }

std::string HelpPage::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

std::string HelpPage::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = is_positional ? option->get_name(true) : option->get_name(false, true);
  if (!is_positional && option->get_expected_max() != 0) name += ' ' + option->get_type_name();
  return entry(name, option->get_description());
}

std::string help_page(const CLI::App& app, const std::string& name) {
  return app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
}

}  // namespace mssim
