#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/expected_time.h"
#include "commands/bench_plan.h"

namespace mssim {

/// What a bench of these scenes takes, one by one. Throws like counts_of.
std::vector<ExpectedTime> expected_times(const SceneJob& job, const std::vector<std::string>& scenes);

/// Prints what would be measured, and about how long that takes. Throws UsageError for a budget that is too
/// short, as the bench would.
void tell_plan(const BenchPlan& plan, std::optional<double> time_budget_s);

}  // namespace mssim
