#include "commands/arguments/program_parser.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "commands/arguments/help_entry.h"
#include "commands/arguments/usage_error.h"

namespace mssim {
namespace {

/// How --help looks: usage, commands or options with a word for their value.
class HelpPage final : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override {
    std::string usage = "\nUsage: " + name;
    for (const CLI::Option* option : app->get_options())
      if (option->get_positional()) usage += ' ' + make_option_usage(option);
    if (!app->get_subcommands({}).empty()) usage += " COMMAND";
    return usage + " [OPTIONS]\n";
  }

  std::string make_description(const CLI::App* app) const override { return app->get_description() + '\n'; }

  std::string make_subcommand(const CLI::App* command) const override {
    return help_entry(command->get_name(), command->get_description());
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string name = is_positional ? option->get_name(true) : option->get_name(false, true);
    if (!is_positional && option->get_expected_max() != 0) name += ' ' + option->get_type_name();
    return help_entry(name, option->get_description());
  }
};

}  // namespace

ProgramParser::ProgramParser(const std::string& name, const std::string& description,
                             const std::string& version)
    : program_(std::make_unique<CLI::App>(description, name)) {
  const auto page = std::make_shared<HelpPage>();
  page->label("Positionals", "Arguments");
  program_->formatter(page);
  program_->set_help_flag("-h,--help", "Show this page");
  program_->set_version_flag("-V,--version", version,
                             "Show the version and the commit that it was built from");
  program_->require_subcommand(0, 1);
}

ProgramParser::~ProgramParser() = default;

Arguments ProgramParser::add_command(const std::string& name, const std::string& description,
                                     const std::string& end) {
  CLI::App* command = program_->add_subcommand(name, description);
  command->group("Commands");
  command->footer(end);
  return Arguments(*command);
}

void ProgramParser::end_help_with(const std::string& text) { program_->footer(text); }

ProgramParser::Request ProgramParser::parse(int argc, const char* const* argv,
                                            const OptionOfWord& option_of) {
  try {
    program_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return {"", usage_sentence(error, *program_, option_of), ""};
    std::ostringstream page;  // --help, --version
    program_->exit(error, page);
    return {page.str(), "", ""};
  }
  const std::vector<CLI::App*> commands = program_->get_subcommands();
  return {"", "", commands.empty() ? "" : commands.front()->get_name()};
}

std::string ProgramParser::help_page() const { return program_->help(); }

}  // namespace mssim
