#include "commands/compare/ab_program.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <thread>

#include "backends/interface/backend.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// The least of so many is hardly disturbed, even where other programs want every processor, too: with eight
/// of them on two processors the ratio of two such spreads by 0.1, that of medians by 0.5.
constexpr int samples_a_process = 7;

/// A verification may be slow, on a busy machine say: it gets so many times the time budget and a minute.
constexpr double verification_limit = 3;
/// Samples take less than a verification, or about as much where each process verifies again.
constexpr double verifications_a_sample = 10;
/// A help page takes a moment.
constexpr double longest_help_s = 60, spare_help_s = 10;

unsigned whole_seconds(double seconds) { return static_cast<unsigned>(seconds + 0.5); }

}  // namespace

AbProgram::AbProgram(const std::string& file, const AbOptions& options) : file_(file), options_(options) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || ::access(file.c_str(), X_OK) != 0)
    throw MissingProgram("cannot run " + file + ": give the path of an mssim program");
  child_.program = fs::absolute(file);
  child_.folder = fs::current_path();  // scenes may be files named from here
  // One that never ends shall not run for ever.
  child_.cpu_seconds =
      static_cast<unsigned>(options.time_budget_s + 60) * std::max(1U, std::thread::hardware_concurrency());
  child_.elapsed_seconds = whole_seconds(verification_limit * (options.time_budget_s + 60));
}

bool AbProgram::takes_verified() const {
  ChildProcess child = child_;
  child.arguments = {"bench", "--help"};
  child.elapsed_seconds = whole_seconds(std::min(longest_help_s, options_.time_budget_s + spare_help_s));
  const ChildResult result = run(child);
  if (result.out_of_time)
    throw UsageError(file_ + " bench --help has not ended within " + std::to_string(child.elapsed_seconds) +
                     " s: give the path of an mssim program");
  return result.signal == 0 && result.exit_code == exit_ok &&
         result.output.find("--verified") != std::string::npos;
}

void AbProgram::allow(double verification_s) {
  child_.elapsed_seconds =
      std::max(child_.elapsed_seconds, whole_seconds(verifications_a_sample * verification_s));
}

ChildProcess AbProgram::verification() const {
  return bench_process(options_.backends, options_.integrators, 1, verified_folder());
}

std::vector<CombinationTime> AbProgram::take_verification(const ChildResult& result) {
  verified_ = true;
  return rows_of(result, verified_folder());
}

std::vector<CombinationTime> AbProgram::bench(const std::vector<std::string>& backends,
                                              const std::vector<std::string>& integrators) const {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "results";
  ChildProcess child = bench_process(backends, integrators, samples_a_process, out);
  if (verified_) child.arguments.insert(child.arguments.end(), {"--verified", verified_folder().string()});
  return rows_of(run(child), out);
}

ChildProcess AbProgram::bench_process(const std::vector<std::string>& backends,
                                      const std::vector<std::string>& integrators, int rounds,
                                      const fs::path& out) const {
  ChildProcess child = child_;
  child.arguments = {"bench",
                     "--scene",
                     join(options_.scenes, ","),
                     "--backend",
                     join(backends, ","),
                     "--integrator",
                     join(integrators, ","),
                     "--rounds",
                     std::to_string(rounds),
                     "--out",
                     out.string()};
  const OwnBackendOptions& own = options_.own_backends;
  if (!own.folders.empty())
    child.arguments.insert(child.arguments.end(), {"--backend-folder", join(own.folders, ",")});
  if (own.limit_s) child.arguments.insert(child.arguments.end(), {"--backend-limit", decimal(*own.limit_s)});
  if (options_.threads > 0)
    child.arguments.insert(child.arguments.end(), {"--threads", std::to_string(options_.threads)});
  return child;
}

std::vector<CombinationTime> AbProgram::rows_of(const ChildResult& result, const fs::path& out) const {
  // A row that is not verified ends a bench with 1; the row says so itself.
  const bool measured = !result.out_of_time && result.signal == 0 &&
                        (result.exit_code == exit_ok || result.exit_code == exit_not_verified);
  if (!measured || !fs::exists(out / "timings.csv")) fail(result);
  return read_combination_times(out / "timings.csv");
}

void AbProgram::fail(const ChildResult& result) const {
  std::cerr << result.output;
  if (!result.output.empty() && !result.output.ends_with('\n')) std::cerr << '\n';
  if (result.out_of_time)
    throw UsageError(file_ + " bench has not ended within " + std::to_string(child_.elapsed_seconds) +
                     " s: run it alone to see why, or give a longer --time-budget");
  const std::string how = result.signal != 0 ? "was ended by signal " + std::to_string(result.signal)
                                             : "exited with " + std::to_string(result.exit_code);
  const std::string sentence = file_ + " bench " + how + " instead of measuring" +
                               (result.output.empty() ? ", without a message" : "; its messages are above");
  if (result.signal == 0 && result.exit_code == exit_unavailable) throw Unavailable(sentence);
  throw UsageError(sentence);
}

}  // namespace mssim
