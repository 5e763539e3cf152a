#pragma once

#include "commands/bench/bench_plan.h"

namespace mssim {

/// Prints what would be measured, and about how long that takes.
void tell_plan(const BenchPlan& plan);

}  // namespace mssim
