#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mssim {

/// What stands in the cells of a Markdown table.

/// 4188004 as 4,188,004.
std::string grouped(std::uint64_t number);

/// Three significant digits, without an exponent.
std::string three_digits(double value);

/// Text that cannot end a cell or a line of the table.
std::string one_cell(std::string_view text);

}  // namespace mssim
