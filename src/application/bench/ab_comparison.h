#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "application/choices.h"
#include "bench/results/comparison.h"
#include "output/tables/results.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {

/// What `mssim compare --ab` was asked for.
struct AbOptions {
  std::string base, next;  ///< programs with the command line of mssim bench
  std::vector<std::string> scenes;
  std::vector<std::string> backends{"openmp"};
  OwnBackendOptions own_backends;
  std::vector<std::string> integrators{"semi-euler"};
  int threads = 0;  ///< 0: what each program takes by itself
  double threshold = 0.05;
  double time_budget_s = 300;
};

/// Has each program verify all combinations once (both at the same time, where the memory does), then runs
/// the two by turns, in a random order in each round, each time as a new process (where its memory happens to
/// lie is then part of the noise and no difference), and compares pairs of the least samples. Where one of
/// them cannot rely on an earlier verification, being older, each process of both verifies again, and stderr
/// says so. A combination is measured until it is settled. Ends when all are, or before a
/// round that would exceed the time budget, of which the verification is part. Says on stderr how many rounds
/// there were. Throws UsageError when a program fails, takes far longer than the budget or there is nothing
/// to compare, MissingProgram when one cannot be run, Unavailable when one misses a device, CsvError for
/// results that cannot be read, and Interrupted, after the program under way has been ended.
RunComparison compare_programs(const AbOptions& options);

}  // namespace mssim
