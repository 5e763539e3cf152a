#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "text/text.h"

namespace mssim {

/// What the value of an argument must be. It says in words what a value is not ("\"x\" is not a positive
/// number"), or nothing where the value is good; the sentence around it, with the argument's name, is
/// usage_error.h's. May replace the text by what it stands for. Empty: any text.
using ValueRule = std::function<std::string(std::string& text)>;

/// Finite and above zero.
ValueRule positive_number();
/// From `low` to `high`.
ValueRule number_between(double low, double high);
ValueRule whole_number(std::int64_t low, std::int64_t high);
/// One of these words, in any case; the text becomes the word as it stands here. `what` is what they name,
/// `others` are words that users type for one of them.
ValueRule one_of(std::string what, std::vector<std::string> words, std::vector<OtherName> others = {});

}  // namespace mssim
