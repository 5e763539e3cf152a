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

/// Checks the value of an argument. Returns why the value is wrong ("\"x\" is not a positive number"), or an
/// empty text if it is right. ProgramParser adds the argument's name and the rest of the sentence. A rule may
/// replace the text by its canonical form. An empty function accepts any text.
struct ValueRule : std::function<std::string(std::string& text)> {
  using function::function;
  std::vector<std::string> words = {};  ///< the only texts that it accepts, if it is a list of them
};

/// Accepts finite numbers above zero.
ValueRule positive_number();
/// Accepts numbers from `low` to `high`.
ValueRule number_between(double low, double high);
/// Accepts whole numbers from `low` to `high`.
ValueRule whole_number(std::int64_t low, std::int64_t high);
/// Accepts one whole number, or several different ones separated by commas.
ValueRule whole_numbers(std::int64_t low, std::int64_t high);
/// Accepts one of these words, in any case, and replaces the text by the word as given here. `what` names
/// their kind; `others` are alternative spellings.
ValueRule one_of(std::string what, std::vector<std::string> words, std::vector<OtherName> others = {});

/// Makes the texts that a shell may complete the value of an argument to.
using OfferedWords = std::function<std::vector<std::string>()>;
/// The offered words of each argument that has some.
using OffersOfOptions = std::map<const CLI::Option*, OfferedWords>;

/// A declared argument: an option, a flag, or a positional argument.
class Argument {
 public:
  /// `name`: as in Arguments. `offers` must outlive it.
  Argument(CLI::Option& option, const std::string& name, OffersOfOptions& offers);

  Argument& required();
  /// Makes it an error to give this without `other`.
  Argument& needs(const Argument& other);
  /// Makes it an error to give this together with `other`.
  Argument& excludes(const Argument& other);
  /// Has shells complete its value to these words, which are made only for that. A rule that is a list of
  /// words offers them by itself.
  Argument& offers(OfferedWords words);

 private:
  CLI::Option* option_;
  OffersOfOptions* offers_;
};

/// Declares the arguments of a command. Only the files of this room include the command-line library, because
/// its header adds seconds to the compilation of each file. A name is `--NAME`; `--NAME VALUE`, with the word
/// for the value in --help; or `WORD` or `WORD VALUE` for a positional argument. A value with FILE, FOLDER or
/// DIR in it is completed by names of files or folders, and one that ends in `,...` after each comma. A
/// target must outlive the parsing; if the argument is not given, it keeps its value, which is the default.
class Arguments {
 public:
  /// `offers` must outlive it.
  Arguments(CLI::App& command, OffersOfOptions& offers) : command_(&command), offers_(&offers) {}

  /// Takes a text that `rule` accepts.
  Argument add(const std::string& name, std::string& target, const std::string& description,
               const ValueRule& rule = {});

  /// Takes a number that `rule` accepts: an int or a double, an optional one, or several. `rule` must only
  /// accept numbers of that type.
  template <class Target>
  Argument add_number(const std::string& name, Target& target, const std::string& description,
                      const ValueRule& rule) {
    return add_taken(
        name, [&target](const std::string& text) { assign(target, text); }, description, rule);
  }

  /// Takes one of these words, in any case; the target becomes its value.
  template <class Value>
  Argument add_choice(const std::string& name, Value& target, const std::map<std::string, Value>& choices,
                      const std::string& description) {
    std::vector<std::string> words;
    for (const auto& [word, value] : choices) words.push_back(word);
    return add_taken(
        name + " WORD", [&target, choices](const std::string& word) { target = choices.at(word); },
        description, one_of("value", std::move(words)));
  }

  /// Takes several texts, separated by commas or, if given, by `split`.
  Argument add_list(const std::string& name, std::vector<std::string>& target, const std::string& description,
                    const std::function<std::vector<std::string>(std::string_view)>& split = {});

  /// Sets the target to true if given.
  Argument add_flag(const std::string& name, bool& target, const std::string& description);

  /// Takes a flag with an optional text; the target is empty if the text is omitted.
  Argument add_flag_with_text(const std::string& name, std::optional<std::string>& target,
                              const std::string& description);

  /// The help page of the program, or of its command `name`; empty if there is no such command.
  std::string help_page(const std::string& name) const;

  /// All help pages as one manual page, in the language of man(7).
  std::string manual_page() const;

 private:
  /// `take` receives the text after `rule` has accepted it.
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

  /// The program that the command is one of.
  const CLI::App& program() const;

  CLI::App* command_;
  OffersOfOptions* offers_;
};

}  // namespace mssim
