#pragma once

#include <string>

#include "output/tables/result_table.h"
#include "platform/machine.h"

namespace mssim {

/// The rows of a bench for a reader, a block for each scene: times with their intervals, whether they are
/// verified, and the speed-up against `serial` as a number and a bar, all bars in one scale. Columns that do
/// not fit the terminal are left out, first what the result folder tells more of, then the bars, then the
/// intervals. Below a block stands why rows have no time. `provenance` tells what was asked
/// for.
std::string row_table(RowPointers rows, const Provenance& provenance, const Terminal& terminal);

}  // namespace mssim
