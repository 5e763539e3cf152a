#include "commands/arguments/program_parser.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "text/text.h"

namespace mssim {
namespace {

/// An entry of a help page, in lines that fit a terminal: `name` on the left, the text on the right.
std::string help_entry(const std::string& name, const std::string& text) {
  constexpr std::size_t left_column = 26, page_width = 80;
  const std::string margin(left_column, ' ');
  std::string page, line, left = "  " + name;
  // A name that fills its column gets a line of its own.
  left += left.size() + 2 > left_column ? '\n' + margin : margin.substr(left.size());
  std::istringstream lines(wrapped(text, page_width - left_column, ""));
  std::getline(lines, line);  // a text without words leaves the name alone
  do {
    page += std::exchange(left, margin) + line + '\n';
  } while (std::getline(lines, line));
  return page;
}

/// The command that was being parsed: the subcommand, if any.
const CLI::App& command_of(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.back();
}

/// The command as a user types it.
std::string typed_name(const CLI::App& command) {
  return command.get_parent() ? "mssim " + command.get_name() : "mssim";
}

/// --NAME for a typed option: without '=VALUE', and with two dashes.
std::string long_form(std::string_view typed) {
  typed = typed.substr(0, typed.find('='));
  typed.remove_prefix(std::min(typed.find_first_not_of('-'), typed.size()));
  return "--" + std::string(typed);
}

std::string unknown_option(const std::string& typed, const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  const std::string name = long_form(typed);
  std::string sentence = fmt::format("{} has no option \"{}\"", typed_name(command),
                                     printable(typed.substr(0, typed.find('='))));
  if (command.get_parent() && !command.get_option_no_throw(name))
    for (const CLI::App* other : command.get_parent()->get_subcommands({}))
      if (other->get_option_no_throw(name)) return sentence + ", which is one of " + typed_name(*other);
  return sentence + did_you_mean(name, std::vector<std::string_view>(known.begin(), known.end()));
}

/// Describes an argument that was not consumed: an unknown option, or an extra word.
std::optional<std::string> leftover(const CLI::App& command, const OptionOfWord& option_of) {
  std::vector<std::string> rest = command.remaining();
  std::erase(rest, "--");  // it only marks the end of options
  const auto option =
      std::ranges::find_if(rest, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
  if (option != rest.end()) return unknown_option(*option, command);
  // The program keeps what its command has not taken of the words behind "--".
  if (rest.empty() && command.get_parent())
    if (const std::vector<std::string> behind = command.get_parent()->remaining(); !behind.empty())
      return fmt::format(
          "unexpected argument \"{}\" of {} behind \"--\": leave it out, or put an option before \"--\"",
          printable(behind.front()), typed_name(command));
  if (rest.empty()) return std::nullopt;
  const std::string word = printable(rest.front()), forgotten = option_of(rest.front());
  return "unexpected argument \"" + word + "\" of " + typed_name(command) +
         (command.get_option_no_throw(forgotten) ? fmt::format(" (did you mean {} {}?)", forgotten, word)
                                                 : ": an option begins with --");
}

/// The option named at the start of a parser's message.
std::string subject_of(std::string_view message) {
  return std::string(message.substr(0, message.find_first_of(": ")));
}

/// Message for a missing option or argument, with the value that it needs.
std::string missing(const std::string& name, const CLI::App& command) {
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return name + " is missing";
  const std::string what = option->get_description();
  return fmt::format("{}{} is missing: give {}{}", name,
                     option->get_positional() ? "" : ' ' + option->get_type_name(),
                     to_lower(what.substr(0, 1)), what.substr(std::min<std::size_t>(1, what.size())));
}

std::string wrong_count(const std::string& name, const CLI::App& command) {
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr || option->get_expected_max() == 0) return name + " takes no value: leave it out";
  if (option->count() > 1) return fmt::format("{} is given {} times: give it once", name, option->count());
  return fmt::format("{0} needs a value: give {0} {1}", name, option->get_type_name());
}

/// The first word of the message that looks like an option.
std::string flag_in(const std::string& message) {
  const std::size_t start = std::min(message.find("--"), message.size());
  return message.substr(start, message.find_first_of(": ", start) - start);
}

std::string problem(const CLI::ParseError& error, const CLI::App& command) {
  std::string message = error.what();
  const std::string subject = subject_of(message);
  const std::string other = message.substr(message.rfind(' ') + 1);
  if (dynamic_cast<const CLI::RequiredError*>(&error)) return missing(subject, command);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return wrong_count(subject, command);
  // Options with a value have a check of their own (ValueRule), so this is a flag.
  if (dynamic_cast<const CLI::ConversionError*>(&error)) return wrong_count(flag_in(message), command);
  if (dynamic_cast<const CLI::RequiresError*>(&error))
    return fmt::format("{0} needs {1}: add it, or leave out {0}", subject, other);
  if (dynamic_cast<const CLI::ExcludesError*>(&error))
    return fmt::format("{} and {} exclude each other: leave out one of them", subject, other);
  return message;  // from the checks in ValueRule
}

/// The error in a command line that was refused by its parser: one sentence with the option, the value and
/// the remedy, ending with a pointer to the help. `app` is the program after parsing as far as possible;
/// `option_of` suggests an option for a stray word.
std::string usage_sentence(const CLI::ParseError& error, const CLI::App& app, const OptionOfWord& option_of) {
  const CLI::App& command = command_of(app);
  // A misspelt option also leaves the correct one missing; report the misspelling.
  const std::optional<std::string> surplus = leftover(command, option_of);
  return fmt::format("{}; see {} --help", surplus.value_or(problem(error, command)), typed_name(command));
}

/// The words of a command line, last first, as CLI11 takes them. `--NAME=` becomes `--NAME` and an empty
/// value: CLI11 would take the next word for the value.
std::vector<std::string> words_from_last(int argc, const char* const* argv) {
  std::vector<std::string> words;
  bool options_end = false;
  for (const std::string word : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
    options_end |= word == "--";
    const bool lacks_value = word.starts_with("--") && word.find('=') == word.size() - 1;
    if (options_end || !lacks_value)
      words.push_back(word);
    else
      words.insert(words.end(), {word.substr(0, word.size() - 1), ""});
  }
  std::ranges::reverse(words);
  return words;
}

/// Layout of --help: usage, then commands or options with the word for their value.
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
  return {*command, offers_};
}

void ProgramParser::end_help_with(const std::string& text) { program_->footer(text); }

ProgramParser::Request ProgramParser::parse(int argc, const char* const* argv,
                                            const OptionOfWord& option_of) {
  try {
    program_->parse(words_from_last(argc, argv));
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
