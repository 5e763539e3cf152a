#pragma once

#include "commands/bench/bench_plan.h"
#include "commands/bench/bench_results.h"
#include "commands/bench/time_budget.h"
#include "commands/shared/stop_request.h"

namespace mssim {

/// Builds and measures the plan's timed scenes, one after the other, but for what the results have of them
/// already, and keeps the rows after every round. With --trace traces each scene behind its measurement. Ends
/// early when it is asked to. Throws like UnbuiltScene::prepare, BenchResults::keep and write_bench_traces.
void measure_scenes(BenchPlan& plan, TimeBudget& budget, const StopRequest& stop, BenchResults& results);

}  // namespace mssim
