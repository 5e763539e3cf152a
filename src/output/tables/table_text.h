#pragma once

#include <string>

#include "output/tables/table.h"

namespace mssim {

/// Columns side by side for a terminal: numbers have at most four significant digits and no groups, nothing
/// is "-". Empty for a table without columns.
std::string table_text(const Table& table);

}  // namespace mssim
