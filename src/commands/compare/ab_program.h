#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands/compare/ab_rounds.h"
#include "output/tables/combination_times.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {

/// One of the two programs of a comparison, run again and again, each time as a new process. All that runs it
/// throws UsageError when the program fails, Unavailable when it misses a device, CsvError for results that
/// cannot be read, and Interrupted, after the process under way has been ended.
class AbProgram {
 public:
  /// Throws MissingProgram for a file that cannot be run.
  AbProgram(const std::string& file, const AbOptions& options);

  /// Whether its bench takes --verified, as its help says. Throws UsageError where it says nothing in a
  /// minute.
  bool takes_verified() const;
  /// The process that verifies everything, so that what is sampled later can rest on it.
  ChildProcess verification() const;
  /// Takes what came of it: the rows of a bench of one round.
  std::vector<CombinationTime> take_verification(const ChildResult& result);
  /// After a verification that took so long, samples may take ten times that, where that is more.
  void allow(double verification_s);
  /// Samples of these backends and integrators, which verifies them again where no verification was taken.
  std::vector<CombinationTime> bench(const std::vector<std::string>& backends,
                                     const std::vector<std::string>& integrators) const;

 private:
  ChildProcess bench_process(const std::vector<std::string>& backends,
                             const std::vector<std::string>& integrators, int rounds,
                             const std::filesystem::path& out) const;
  std::vector<CombinationTime> rows_of(const ChildResult& result, const std::filesystem::path& out) const;
  std::filesystem::path verified_folder() const { return folder_.path() / "verified"; }
  [[noreturn]] void fail(const ChildResult& result) const;

  std::string file_;
  const AbOptions& options_;
  ChildProcess child_;  ///< without arguments
  TemporaryFolder folder_;
  bool verified_ = false;
};

}  // namespace mssim
