#include "commands/arguments/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace mssim {

namespace {

/// The rule for a number that `accepts` takes; `what` is what it is then.
template <class Number, class Accepts>
ValueRule number_that(std::string what, Accepts accepts) {
  return [what = std::move(what), accepts](const std::string& text) -> std::string {
    const std::optional<Number> number = number_in<Number>(text);
    return number && accepts(*number) ? "" : fmt::format("\"{}\" is not {}", printable(text), what);
  };
}

}  // namespace

ValueRule positive_number() {
  return number_that<double>("a positive number",
                             [](double number) { return std::isfinite(number) && number > 0; });
}

ValueRule number_between(double low, double high) {
  std::ostringstream range;
  range << "a number from " << low << " to " << high;
  return number_that<double>(range.str(),
                             [low, high](double number) { return number >= low && number <= high; });
}

ValueRule whole_number(std::int64_t low, std::int64_t high) {
  return number_that<std::int64_t>(
      fmt::format("a whole number from {} to {}", low, high),
      [low, high](std::int64_t number) { return number >= low && number <= high; });
}

ValueRule one_of(std::string what, std::vector<std::string> words, std::vector<OtherName> others) {
  return [what = std::move(what), words = std::move(words),
          others = std::move(others)](std::string& text) -> std::string {
    const auto match = std::ranges::find(words, to_lower(text));
    if (match == words.end())
      return unknown_name(what, text, std::vector<std::string_view>(words.begin(), words.end()), others);
    text = *match;
    return "";
  };
}

Argument& Argument::value_name(const std::string& word) {
  option_->type_name(word);
  return *this;
}

Argument& Argument::required() {
  option_->required();
  return *this;
}

Argument& Argument::needs(const Argument& other) {
  option_->needs(other.option_);
  return *this;
}

Argument& Argument::excludes(const Argument& other) {
  option_->excludes(other.option_);
  return *this;
}

namespace {

/// What is given empty, for example by a script whose variable is not set, would else count as not given.
std::string filled(const std::string& text) {
  return text.empty() ? "\"\" is empty: give a value, or leave the option out" : "";
}

}  // namespace

Argument Arguments::add(const std::string& name, std::string& target, const std::string& description,
                        const ValueRule& rule) {
  return add_taken(
      name, [&target](const std::string& text) { target = text; }, description,
      [rule](std::string& text) { return text.empty() ? filled(text)
                                         : rule       ? rule(text)
                                                      : ""; });
}

Argument Arguments::add_taken(const std::string& name, const std::function<void(const std::string&)>& take,
                              const std::string& description, const ValueRule& rule) {
  CLI::Option* option = command_->add_option_function<std::string>(name, take, description);
  if (rule) option->transform(CLI::Validator(rule, ""));
  return Argument(*option);
}

Argument Arguments::add_list(const std::string& name, std::vector<std::string>& target,
                             const std::string& description,
                             const std::function<std::vector<std::string>(std::string_view)>& split) {
  const CLI::Validator all_filled(filled, "");
  if (!split)
    return Argument(*command_->add_option(name, target, description)->delimiter(',')->check(all_filled));
  const auto take = [&target, split](const std::vector<std::string>& texts) {
    target.clear();
    for (const std::string& text : texts) std::ranges::move(split(text), std::back_inserter(target));
  };
  return Argument(
      *command_->add_option_function<std::vector<std::string>>(name, take, description)->check(all_filled));
}

Argument Arguments::add_flag(const std::string& name, bool& target, const std::string& description) {
  return Argument(*command_->add_flag(name, target, description));
}

Argument Arguments::add_flag_with_text(const std::string& name, std::optional<std::string>& target,
                                       const std::string& description) {
  const auto take = [&target](const std::string& text) { target = text; };
  return Argument(
      *command_->add_option_function<std::string>(name, take, description)->expected(0, 1)->default_str(""));
}

std::string Arguments::help_page(const std::string& name) const {
  const CLI::App* program = command_;
  while (program->get_parent() != nullptr) program = program->get_parent();
  // App::help() would show the page of the command that has been parsed.
  const auto page = [](const CLI::App& app, const std::string& typed_name) {
    return app.get_formatter()->make_help(&app, typed_name, CLI::AppFormatMode::Normal);
  };
  if (name.empty()) return page(*program, program->get_name());
  for (const CLI::App* command : program->get_subcommands({}))
    if (command->get_name() == name) return page(*command, program->get_name() + ' ' + name);
  return {};
}

}  // namespace mssim
