#pragma once

#include <string>
#include <vector>

#include "commands/ab_rounds.h"
#include "mesh/child_process.h"
#include "mesh/temporary_folder.h"
#include "output/combination_times.h"

namespace mssim {

/// One of the two programs of a comparison, run again and again, each time as a new process. All that runs it
/// throws UsageError when the program fails, Unavailable when it misses a device, CsvError for results that
/// cannot be read, and Interrupted, after the process under way has been ended.
class AbProgram {
 public:
  /// Throws MissingProgram for a file that cannot be run.
  AbProgram(const std::string& file, const AbOptions& options);

  /// Whether its bench takes --verified, as its help says.
  bool takes_verified() const;
  /// Verifies everything, once, for all times to come: what a process measures then rests on this one. The
  /// rows are those of a bench of one round.
  std::vector<CombinationTime> verify();
  /// Samples of these backends and integrators, verified here too if verify() has not been called.
  std::vector<CombinationTime> bench(const std::vector<std::string>& backends,
                                     const std::vector<std::string>& integrators) const;

 private:
  std::vector<CombinationTime> results_of(std::vector<std::string> arguments,
                                          const std::filesystem::path& out) const;
  [[noreturn]] void fail(const ChildResult& result) const;

  std::string file_;
  const AbOptions& options_;
  ChildProcess child_;  ///< without arguments
  TemporaryFolder folder_;
  bool verified_ = false;
};

}  // namespace mssim
