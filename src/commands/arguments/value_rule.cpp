#include "commands/arguments/value_rule.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

/// The rule for a number that `accepts` takes; `what` is what it is then.
template <class Number, class Accepts>
ValueRule number_that(std::string what, Accepts accepts) {
  return [what = std::move(what), accepts](const std::string& text) -> std::string {
    const std::optional<Number> number = number_in<Number>(text);
    return number && accepts(*number) ? "" : "\"" + printable(text) + "\" is not " + what;
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
      "a whole number from " + std::to_string(low) + " to " + std::to_string(high),
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

}  // namespace mssim
