#pragma once

#include <optional>
#include <string>

#include "output/tables/table.h"

namespace mssim {

/// Columns side by side for a terminal: numbers have at most four significant digits and no groups, nothing
/// is "-". Empty for a table without columns.
std::string table_text(const Table& table);

/// A table of one row as text. Where it is wider than `width` columns, a line for each value that there
/// is.
std::string record_text(const Table& table, std::optional<int> width);

}  // namespace mssim
