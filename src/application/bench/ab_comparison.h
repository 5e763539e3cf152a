#pragma once

#include <string>

#include "application/choices.h"
#include "bench/results/comparison.h"
#include "output/tables/results.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {

/// Request of `mssim compare --ab`. Of `execution` it has the threads; 0: each program's default.
struct AbOptions : AskedCombinations {
  std::string base, next;  ///< programs with the command line of mssim bench
  double threshold = 0.05;
  double time_budget_s = 300;
};

/// Compares two programs. Each program verifies all combinations once, both at the same time if there is
/// enough memory. Then they run alternately, in random order within each round and each time as a new
/// process, so that differences in memory layout are part of the noise. Pairs of their least samples are
/// compared. If one of them is too old to rely on an earlier verification, each process of both verifies
/// again, and stderr says so.
///
/// A combination is measured until it is settled. The comparison ends when all are, or before a round that
/// would exceed the time budget, which includes the verification. An ending signal ends it, too, and stays
/// noted; before the first round has ended it is thrown. Prints the number of rounds to stderr.
/// Throws UsageError if a program fails, if it takes far longer than the budget, or if there is nothing to
/// compare; MissingProgram if one cannot be run; Unavailable if one lacks a device; CsvError for results that
/// cannot be read; and Interrupted, after the running program has been ended.
RunComparison compare_programs(const AbOptions& options);

}  // namespace mssim
