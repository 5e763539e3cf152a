#pragma once

#include <cstdint>
#include <string>

#include "output/tables/table.h"

namespace mssim {

/// How a command prints a table.
enum class ListingFormat : std::uint8_t { table, csv, json };

/// Columns for a terminal, CSV whose numbers are JSON's, or a JSON array. Ends with a newline; a table
/// without rows is empty text, or an empty array.
std::string to_text(const Table& table, ListingFormat format);

}  // namespace mssim
