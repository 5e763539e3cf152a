#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/job/scene_job.h"
#include "commands/bench/bench_summary.h"
#include "commands/bench/suites.h"

namespace mssim {

/// What `mssim bench` was asked for.
struct BenchOptions {
  std::vector<std::string> scenes;
  std::string suite;
  std::vector<std::string> backends;
  std::vector<std::string> integrators;
  ExecutionOptions execution;
  std::optional<int> rounds;  ///< none: the usual number, or as many as the budget allows
  std::optional<double> time_budget_s;
  bool dry_run = false;
  bool trace = false;
  std::string out;
  SummaryFormat format = SummaryFormat::table;
  bool resume = false;
  bool overwrite = false;
  std::string verified;  ///< a folder whose rows need not be verified again; empty: none
};

/// Rounds of a bench that says nothing of them.
inline constexpr int usual_rounds = 15;
inline constexpr int most_rounds = 100'000;

/// What it means.
struct BenchPlan {
  std::vector<std::string> timed;      ///< scenes that are measured
  std::vector<std::string> described;  ///< scenes of which the structure is told
  SceneJob job;                        ///< for every scene; the scene's own part is empty
  TableMaker tables;
};

/// Throws UsageError for names that are not known and for nothing to do, and what reading published tables
/// throws.
BenchPlan plan_of(const BenchOptions& options);

}  // namespace mssim
