// What shells and man get of the declared arguments: completions and the manual page.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <vector>

#include "commands/arguments/arguments.h"
#include "commands/arguments/program_parser.h"

namespace mssim {
namespace {

bool takes_value(const CLI::Option* option) { return option != nullptr && option->get_expected_max() != 0; }

std::vector<const CLI::Option*> positionals_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

/// The last word of a command line.
struct TypedWord {
  const CLI::App* command = nullptr;    ///< whose word it is; null if nothing can stand here
  const CLI::Option* option = nullptr;  ///< whose value it is; null for a command or an option
  /// The word, divided before the part that is completed by itself: after `--NAME=`, after a comma.
  std::string before = {}, text = {};
};

/// Reads the words before the last one as the parser does.
TypedWord typed_word(const CLI::App& program, std::span<const std::string> words) {
  TypedWord typed{&program};
  std::vector<const CLI::Option*> positionals;
  for (const std::string& word : words.first(words.size() - 1)) {
    const bool is_value = typed.option != nullptr && !word.starts_with("--");
    typed.option = nullptr;
    if (is_value) continue;
    if (word.starts_with('-')) {
      const CLI::Option* option = typed.command->get_option_no_throw(word);
      if (takes_value(option)) typed.option = option;
    } else if (typed.command == &program) {
      const auto commands = program.get_subcommands({});
      const auto command = std::ranges::find(commands, word, &CLI::App::get_name);
      if (command == commands.end()) return {};
      typed.command = *command;
      positionals = positionals_of(**command);
    } else if (positionals.size() > 1) {  // the last one may be given several times
      positionals.erase(positionals.begin());
    }
  }
  typed.text = words.back();
  if (typed.text.starts_with("--")) {
    typed.option = nullptr;
    if (const std::size_t equals = typed.text.find('='); equals != std::string::npos) {
      typed.option = typed.command->get_option_no_throw(typed.text.substr(0, equals));
      if (!takes_value(typed.option)) return {};
      typed.before = typed.text.substr(0, equals + 1);
    }
  } else if (typed.option == nullptr && !typed.text.starts_with('-') && !positionals.empty()) {
    typed.option = positionals.front();
  }
  if (typed.option != nullptr && typed.option->get_type_name().ends_with(",..."))
    if (const std::size_t comma = typed.text.rfind(','); comma != std::string::npos)
      typed.before = typed.text.substr(0, comma + 1);
  typed.text.erase(0, typed.before.size());
  return typed;
}

/// Text in the language of man(7), where a plain hyphen is no minus, and a dot at the start of a line begins
/// a request.
std::string roff(std::string_view text) {
  std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char character : text) {
    if (character == '-' || character == '\\') escaped += '\\';
    escaped += character == '\\' ? 'e' : character;
  }
  return escaped;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

/// The arguments and options of a command, or the options of the program.
std::string manual_entries(const CLI::App& command) {
  std::string entries;
  for (const CLI::Option* argument : positionals_of(command))
    entries += ".TP\n" + italic(argument->get_name(true)) + '\n' + roff(argument->get_description()) + '\n';
  for (const CLI::Option* option : options_of(command)) {
    entries += ".TP\n" + bold(option->get_name(false, true));
    if (takes_value(option)) entries += ' ' + italic(option->get_type_name());
    entries += '\n' + roff(option->get_description()) + '\n';
  }
  return entries;
}

/// The end of a help page: paragraphs, and indented commands. With `sections`, the words before the colon at
/// the start of a paragraph are the heading of a section.
std::string manual_end(const std::string& text, bool sections) {
  std::istringstream lines(text);
  std::string page, line;
  for (bool begins = true; std::getline(lines, line); begins = line.empty()) {
    const std::size_t colon = line.find(':');
    if (line.starts_with("  ")) {
      page += ".nf\n" + bold(line.substr(2)) + "\n.fi\n";
    } else if (begins && sections && colon != std::string::npos) {
      std::string heading = line.substr(0, colon);
      for (char& letter : heading)
        letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
      page += ".SH " + heading + '\n';
      if (colon + 2 < line.size()) page += roff(line.substr(colon + 2)) + '\n';
    } else if (!line.empty()) {
      page += (begins ? ".PP\n" : "") + roff(line) + '\n';
    }
  }
  return page;
}

}  // namespace

std::string ProgramParser::completions(std::span<const std::string> words) const {
  const std::string nothing;
  const TypedWord typed = typed_word(*program_, words.empty() ? std::span(&nothing, 1) : words);
  std::string kind = "words", lines;
  const auto add = [&](const std::string& word, const std::string& description) {
    if (!word.starts_with(typed.text)) return;
    lines += typed.before + word + (description.empty() ? "" : '\t' + description) + '\n';
  };
  if (typed.option != nullptr) {
    const std::string value = typed.option->get_type_name();
    const auto has = [&](const char* word) { return value.find(word) != std::string::npos; };
    kind = has("FILE") ? "file" : has("FOLDER") || has("DIR") ? "directory" : "words";
    if (const auto offered = offers_.find(typed.option); offered != offers_.end())
      for (const std::string& word : offered->second()) add(word, "");
  } else if (typed.command == program_.get() && !typed.text.starts_with('-')) {
    for (const CLI::App* command : program_->get_subcommands({}))
      add(command->get_name(), command->get_description());
  } else if (typed.command != nullptr) {
    for (const CLI::Option* option : options_of(*typed.command))
      for (const std::string& name : option->get_lnames()) add("--" + name, option->get_description());
  }
  return kind + '\t' + typed.before + '\n' + lines;
}

std::string Arguments::manual_page() const {
  const std::string about = program().get_description(), name = program().get_name();
  const std::size_t colon = about.find(": ");  // after name and version
  std::string page =
      fmt::format(".TH {} 1 \"\" \"{}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{} {} [{}]\n.SH DESCRIPTION\n",
                  name, about.substr(0, colon), name, roff(about.substr(colon + 2)), bold(name),
                  italic("COMMAND"), italic("OPTIONS"));
  page += manual_end(program().get_footer(), true) + ".SH OPTIONS\n" + manual_entries(program()) +
          ".SH COMMANDS\n";
  for (const CLI::App* command : program().get_subcommands({}))
    page +=
        fmt::format(".SS {} {}\n{}\n", name, roff(command->get_name()), roff(command->get_description())) +
        manual_entries(*command) + manual_end(command->get_footer(), false);
  return page;
}

}  // namespace mssim
