#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mssim {

/// Columns that UTF-8 takes, in a terminal or in letters of a chart: one a character, two for wide ones.
std::size_t width_of(std::string_view text);

/// What of UTF-8 fits into so many columns.
std::string_view clipped(std::string_view text, std::size_t width);

/// `text` in lines of at most `width` characters, broken between words, those but the first behind `indent`.
/// A word that is longer than a line stays whole.
std::string wrapped(std::string_view text, std::size_t width, std::string_view indent);

/// A bar of at most `width` characters for a fraction from 0 to 1, in eighths of a character with UTF-8, else
/// of whole #. What is above zero is seen.
std::string bar(double fraction, std::size_t width, bool utf8);

}  // namespace mssim
