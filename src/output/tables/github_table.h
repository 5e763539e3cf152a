#pragma once

#include <span>

#include "bench/results/result.h"
#include "output/tables/table.h"

namespace mssim {

/// The rows that are ok as github-action-benchmark reads them from JSON ("customSmallerIsBetter"): name
/// (scene/backend/integrator), unit, value (median) and range (the 95 % interval of the median), with device
/// and threads as `extra`.
Table github_table(std::span<const ResultRow> rows);

}  // namespace mssim
