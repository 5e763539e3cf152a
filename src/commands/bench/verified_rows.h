#pragma once

#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "commands/bench/bench_plan.h"

namespace mssim {

/// The rows of a result folder in which all that the plan times has been verified before, by the very program
/// that runs now (the same bytes), on the same machine, for the same threads, devices and scenes; whatever of
/// them failed there stays failed. Throws UsageError where it is not so, and what reading them throws.
/// `now`: with the plan's scenes.
std::vector<ResultRow> verified_rows(const std::string& folder, const Provenance& now, const BenchPlan& plan);

}  // namespace mssim
