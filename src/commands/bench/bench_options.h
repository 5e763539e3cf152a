#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "commands/bench/bench_summary.h"
#include "commands/shared/backend_choice.h"

namespace mssim {

/// Where the results of a bench go.
struct BenchOutput {
  std::string folder;  ///< empty: they are only printed
  bool resume = false;
  bool overwrite = false;
  bool trace = false;
  SummaryFormat format = SummaryFormat::table;
};

/// What `mssim bench` was asked for.
struct BenchOptions {
  std::vector<std::string> scenes;
  std::string suite;
  std::vector<std::string> backends;
  OwnBackendOptions own_backends;
  std::vector<std::string> integrators;
  ExecutionOptions execution;
  std::optional<int> rounds;  ///< none: the usual number, or as many as the budget allows
  std::optional<double> time_budget_s;
  std::optional<int> windows;  ///< none: only cloths that do not fit are verified in windows
  bool dry_run = false;
  BenchOutput output;
  std::string verified;  ///< a folder whose rows need not be verified again; empty: none
};

/// Rounds of a bench that says nothing of them.
inline constexpr int usual_rounds = 15;
inline constexpr int most_rounds = 100'000;

}  // namespace mssim
