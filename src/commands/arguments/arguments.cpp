#include "commands/arguments/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace mssim {
namespace {

/// A rule for numbers that satisfy `accepts`; `what` describes such a number.
template <class Number, class Accepts>
ValueRule number_that(std::string what, Accepts accepts) {
  return [what = std::move(what), accepts](const std::string& text) -> std::string {
    const std::optional<Number> number = number_in<Number>(text);
    return number && accepts(*number) ? "" : fmt::format("\"{}\" is not {}", printable(text), what);
  };
}

/// An empty value, for example from an unset variable of a script, would otherwise count as not given.
std::string filled(const std::string& text) {
  return text.empty() ? "\"\" is empty: give a value, or leave the option out" : "";
}

/// A list of nothing but commas would count as not given, too, or take the next word for its first name.
std::string names_something(const std::string& text) {
  if (text.empty() || text.find_first_not_of(',') != std::string::npos) return filled(text);
  return fmt::format("\"{}\" names nothing: give a value, or leave the option out", text);
}

/// The names between commas.
std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names;
  std::istringstream rest{std::string(text)};
  for (std::string name; std::getline(rest, name, ',');)
    if (!name.empty()) names.push_back(name);
  return names;
}

/// The argument's name without the word for its value.
std::string name_alone(const std::string& name) { return name.substr(0, name.find(' ')); }

}  // namespace

ValueRule positive_number() {
  return number_that<double>("a positive number",
                             [](double number) { return std::isfinite(number) && number > 0; });
}

ValueRule number_between(double low, double high) {
  return number_that<double>(fmt::format("a number from {:.6g} to {:.6g}", low, high),
                             [low, high](double number) { return number >= low && number <= high; });
}

ValueRule whole_number(std::int64_t low, std::int64_t high) {
  return number_that<std::int64_t>(
      fmt::format("a whole number from {} to {}", low, high),
      [low, high](std::int64_t number) { return number >= low && number <= high; });
}

ValueRule whole_numbers(std::int64_t low, std::int64_t high) {
  return [one = whole_number(low, high), low, high](std::string& text) -> std::string {
    if (text.find(',') == std::string::npos) return one(text);
    std::vector<std::int64_t> numbers = numbers_in<std::int64_t>(text);
    std::ranges::sort(numbers);
    const bool good = !numbers.empty() && numbers.front() >= low && numbers.back() <= high &&
                      std::ranges::adjacent_find(numbers) == numbers.end();
    return good ? ""
                : fmt::format("\"{}\" is not a list of different whole numbers from {} to {}",
                              printable(text), low, high);
  };
}

ValueRule one_of(std::string what, std::vector<std::string> words, std::vector<OtherName> others) {
  ValueRule rule = [what = std::move(what), words,
                    others = std::move(others)](std::string& text) -> std::string {
    const auto match = std::ranges::find(words, to_lower(text));
    if (match == words.end())
      return unknown_name(what, text, std::vector<std::string_view>(words.begin(), words.end()), others);
    text = *match;
    return "";
  };
  rule.words = std::move(words);
  return rule;
}

Argument::Argument(CLI::Option& option, const std::string& name, OffersOfOptions& offers)
    : option_(&option), offers_(&offers) {
  if (const std::size_t blank = name.find(' '); blank != std::string::npos)
    option.type_name(name.substr(blank + 1));
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

Argument& Argument::offers(OfferedWords words) {
  (*offers_)[option_] = std::move(words);
  return *this;
}

Argument Arguments::add(const std::string& name, std::string& target, const std::string& description,
                        const ValueRule& rule) {
  ValueRule filled_rule = [rule](std::string& text) {
    return text.empty() ? filled(text) : rule ? rule(text) : "";
  };
  filled_rule.words = rule.words;
  return add_taken(
      name, [&target](const std::string& text) { target = text; }, description, filled_rule);
}

Argument Arguments::add_taken(const std::string& name, const std::function<void(const std::string&)>& take,
                              const std::string& description, const ValueRule& rule) {
  CLI::Option* option = command_->add_option_function<std::string>(name_alone(name), take, description);
  if (rule) option->transform(CLI::Validator(rule, ""));
  Argument argument(*option, name, *offers_);
  if (!rule.words.empty()) argument.offers([words = rule.words] { return words; });
  return argument;
}

Argument Arguments::add_list(const std::string& name, std::vector<std::string>& target,
                             const std::string& description,
                             const std::function<std::vector<std::string>(std::string_view)>& split) {
  const auto take = [&target, split](const std::vector<std::string>& texts) {
    target.clear();
    for (const std::string& text : texts)
      std::ranges::move(split ? split(text) : names_in(text), std::back_inserter(target));
  };
  using Texts = std::vector<std::string>;
  CLI::Option* option = command_->add_option_function<Texts>(name_alone(name), take, description);
  return {*option->check(CLI::Validator(names_something, "")), name, *offers_};
}

Argument Arguments::add_flag(const std::string& name, bool& target, const std::string& description) {
  return {*command_->add_flag(name, target, description), name, *offers_};
}

Argument Arguments::add_flag_with_text(const std::string& name, std::optional<std::string>& target,
                                       const std::string& description) {
  CLI::Option* option = command_->add_option_function<std::string>(
      name_alone(name), [&target](const std::string& text) { target = text; }, description);
  return {*option->expected(0, 1)->default_str(""), name, *offers_};
}

const CLI::App& Arguments::program() const {
  const CLI::App* program = command_;
  while (program->get_parent() != nullptr) program = program->get_parent();
  return *program;
}

std::string Arguments::help_page(const std::string& name) const {
  // App::help() would show the page of the command that has been parsed.
  const auto page = [](const CLI::App& app, const std::string& typed_name) {
    return app.get_formatter()->make_help(&app, typed_name, CLI::AppFormatMode::Normal);
  };
  if (name.empty()) return page(program(), program().get_name());
  for (const CLI::App* command : program().get_subcommands({}))
    if (command->get_name() == name) return page(*command, program().get_name() + ' ' + name);
  return {};
}

}  // namespace mssim
