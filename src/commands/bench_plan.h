#pragma once

#include <string>
#include <vector>

#include "bench/bench_scene.h"
#include "commands/suites.h"

namespace mssim {

/// What `mssim bench` was asked for.
struct BenchOptions {
  std::vector<std::string> scenes;
  std::string suite;
  std::vector<std::string> backends;
  std::vector<std::string> integrators;
  ExecutionOptions execution;
  int rounds = 15;
  bool trace = false;
  std::string out;
  bool resume = false;
  bool overwrite = false;
};

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
