#pragma once

#include <string>
#include <vector>

#include "bench/results/result.h"
#include "commands/bench/bench_plan.h"
#include "output/folders/result_folder.h"

namespace mssim {

/// What stands in the folder already and is to stay: with --resume what an earlier run of the same program on
/// the same machine left, with --overwrite nothing. Throws UsageError where the folder has results and
/// neither was asked for, or where --resume would mix what is not alike or keep scenes that this command does
/// not have, and what reading them throws.
std::vector<ResultRow> earlier_rows(ResultFolder& folder, const BenchPlan& plan);

/// Throws UsageError where there are sentences that say why --resume cannot continue in the folder.
void require_resumable(const std::vector<std::string>& differences, const std::string& folder);

}  // namespace mssim
