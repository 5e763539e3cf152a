#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/results/result.h"
#include "output/tables/results.h"

namespace mssim {

/// What the files about garments have in common.

/// The rows of all scenes that any backend has dressed, in their order.
std::vector<const ResultRow*> rows_of_dressed_scenes(std::span<const ResultRow> rows);

/// Milliseconds an iteration, over a whole dressing; none where there was no iteration.
std::optional<double> ms_per_iteration(const DressingRecord& dressing);

/// Makes the table `figure6` of the scenes that are garments, laid out as Figure 6 of Vassilev: milliseconds
/// an iteration against vertices, without parallelisation (`serial`) and with (the other backends), and what
/// the figure does not show: the speed-up, the time of an iteration and vertex, and how long the whole
/// dressing took. None where nothing was dressed.
TableMaker garment_tables();

}  // namespace mssim
