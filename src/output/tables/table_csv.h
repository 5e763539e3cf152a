#pragma once

#include <string>

#include "output/tables/csv.h"
#include "output/tables/table.h"

namespace mssim {

/// RFC 4180 CSV: the names of the columns, then the rows; nothing is an empty field. Empty for a table
/// without columns. `real` spells reals: as in result files, or as a caller has it. csv_number() throws
/// std::invalid_argument for a number that is not finite.
std::string table_csv(const Table& table, std::string (*real)(double) = csv_number);

}  // namespace mssim
