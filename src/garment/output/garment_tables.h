#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/result.h"
#include "output/tables/results.h"
#include "output/tables/table.h"

namespace mssim {

/// garment.csv: a line for every row of the scenes that any backend has dressed: milliseconds an iteration of
/// the draped garment, nanoseconds an iteration and vertex, how the dressing went and what it took, and the
/// numbers of the fit, each that has bounds followed by NAME_within. Empty text where nothing was dressed.
/// Throws std::invalid_argument for a number that is not finite.
std::string garment_csv(std::span<const ResultRow> rows);

/// Reads the dressings of a garment.csv into those of `rows` that it has; others stay as they are. Throws
/// CsvError.
void read_dressings(const CsvTable& table, std::span<ResultRow> rows);

/// Whether a backend's rows stand for the curves of Figure 6 with parallelisation: those of all but `serial`
/// and of the published loops that are made for one thread.
bool is_parallel(std::string_view backend);

/// Makes the table `figure6` of the scenes that are garments, laid out as Figure 6 of Vassilev: milliseconds
/// an iteration against vertices, without parallelisation and with, of Algorithm 1 as printed and of mssim's
/// own form of it, and what
/// the figure does not show: the speed-up, the time of an iteration and vertex, and how long the whole
/// dressing took. None where nothing was dressed.
TableMaker garment_tables();

}  // namespace mssim
