#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/results/result.h"

namespace mssim {

/// What the files about garments have in common.

/// The rows of all scenes that any backend has dressed, in their order.
std::vector<const ResultRow*> rows_of_dressed_scenes(std::span<const ResultRow> rows);

/// Milliseconds an iteration, over a whole dressing; none where there was no iteration.
std::optional<double> ms_per_iteration(const DressingRecord& dressing);

}  // namespace mssim
