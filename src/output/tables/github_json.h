#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "bench/results/result.h"

namespace mssim {

/// The rows that are ok as github-action-benchmark reads them ("customSmallerIsBetter"): a list of name
/// (scene/backend/integrator), unit, value (median) and range (the 95 % interval of the median), with device
/// and threads as `extra`.
nlohmann::ordered_json github_json(std::span<const ResultRow> rows);

}  // namespace mssim
