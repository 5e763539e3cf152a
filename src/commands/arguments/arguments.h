#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text/text.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace mssim {

/// What the value of an argument must be. It says in words what a value is not ("\"x\" is not a positive
/// number"), or nothing where the value is good; the sentence around it, with the argument's name, is
/// ProgramParser's. May replace the text by what it stands for. Empty: any text.
using ValueRule = std::function<std::string(std::string& text)>;

/// Finite and above zero.
ValueRule positive_number();
/// From `low` to `high`.
ValueRule number_between(double low, double high);
ValueRule whole_number(std::int64_t low, std::int64_t high);
/// One of them, or several different ones that commas separate.
ValueRule whole_numbers(std::int64_t low, std::int64_t high);
/// One of these words, in any case; the text becomes the word as it stands here. `what` is what they name,
/// `others` are words that users type for one of them.
ValueRule one_of(std::string what, std::vector<std::string> words, std::vector<OtherName> others = {});

/// An argument that has been declared: an option, a flag, or a word without a name.
class Argument {
 public:
  /// `name`: as Arguments takes it.
  Argument(CLI::Option& option, const std::string& name);

  Argument& required();
  /// It is an error without `other`.
  Argument& needs(const Argument& other);
  /// It is an error together with `other`.
  Argument& excludes(const Argument& other);

 private:
  CLI::Option* option_;
};

/// Declares what a command takes on its command line. The command-line library stands behind it, in three
/// files of this folder: its header costs each file that includes it seconds of compiling. A name is
/// `--NAME`, or `--NAME VALUE` with the word for its value in --help, or `WORD` of an argument without a
/// name. A target must outlive the parsing and keeps its value, the default, where the argument is not given.
class Arguments {
 public:
  explicit Arguments(CLI::App& command) : command_(&command) {}

  /// A text that `rule` accepts.
  Argument add(const std::string& name, std::string& target, const std::string& description,
               const ValueRule& rule = {});

  /// A number, an int or double, an optional one or several, that `rule` accepts; it accepts numbers of that
  /// kind only.
  template <class Target>
  Argument add_number(const std::string& name, Target& target, const std::string& description,
                      const ValueRule& rule) {
    return add_taken(
        name, [&target](const std::string& text) { assign(target, text); }, description, rule);
  }

  /// One of these words, in any case; the target becomes what it stands for.
  template <class Value>
  Argument add_choice(const std::string& name, Value& target, const std::map<std::string, Value>& choices,
                      const std::string& description) {
    std::vector<std::string> words;
    for (const auto& [word, value] : choices) words.push_back(word);
    return add_taken(
        name + " WORD", [&target, choices](const std::string& word) { target = choices.at(word); },
        description, one_of("value", std::move(words)));
  }

  /// Several texts, separated by commas or, with `split`, by what it takes one text apart at.
  Argument add_list(const std::string& name, std::vector<std::string>& target, const std::string& description,
                    const std::function<std::vector<std::string>(std::string_view)>& split = {});

  /// True when it is given.
  Argument add_flag(const std::string& name, bool& target, const std::string& description);

  /// A flag that may be followed by a text: the target is empty where that is left out.
  Argument add_flag_with_text(const std::string& name, std::optional<std::string>& target,
                              const std::string& description);

  /// The help page of the program that the command belongs to or, with a name, of that command of it; empty
  /// where there is no such command.
  std::string help_page(const std::string& name) const;

 private:
  /// `take` gets the text as `rule` has left it.
  Argument add_taken(const std::string& name, const std::function<void(const std::string&)>& take,
                     const std::string& description, const ValueRule& rule);

  template <class Number>
  static void assign(Number& target, const std::string& text) {
    target = number_in<Number>(text).value();
  }
  template <class Number>
  static void assign(std::optional<Number>& target, const std::string& text) {
    assign(target.emplace(), text);
  }
  template <class Number>
  static void assign(std::vector<Number>& target, const std::string& text) {
    target = numbers_in<Number>(text);
  }

  CLI::App* command_;
};

}  // namespace mssim
