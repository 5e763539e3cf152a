#pragma once

#include <span>
#include <string>
#include <string_view>

#include "bench/results/result.h"
#include "output/tables/results.h"
#include "output/tables/table.h"

namespace mssim {

/// garment.csv: a line for every row of a scene that any backend has dressed. Its columns are times per
/// iteration of the draped garment, outcome and duration of the dressing, and the numbers of the fit;
/// NAME_within follows a number with bounds. Empty if nothing was dressed. Throws std::invalid_argument for a
/// number that is not finite.
std::string garment_csv(std::span<const ResultRow> rows);

/// Reads the dressings of a garment.csv into the matching `rows`; others do not change. Throws CsvError.
void read_dressings(const CsvTable& table, std::span<ResultRow> rows);

/// Whether a backend's rows belong to the curves of Figure 6 with parallelisation: all but `serial` and the
/// published loops for one thread.
bool is_parallel(std::string_view backend);

/// Makes the table `figure6` of garment scenes, laid out as Figure 6 of Vassilev: milliseconds per iteration
/// against vertices, with and without parallelisation, for Algorithm 1 as printed and mssim's own form. It
/// adds the speed-up, the time per iteration and vertex, and the duration of the dressing. None if nothing
/// was dressed.
TableMaker garment_tables();

}  // namespace mssim
