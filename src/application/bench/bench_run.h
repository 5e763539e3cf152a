#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "application/bench/bench_plan.h"
#include "application/bench/bench_results.h"
#include "application/console.h"
#include "application/prepared_scene.h"
#include "bench/bench_scene.h"
#include "bench/estimates.h"
#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "text/error.h"

namespace mssim {

/// How a bench ends, and why.
struct BenchVerdict {
  /// 1 when a measured row is wrong; 3 when a backend or integrator that was asked for by name could not run.
  ExitCode exit_code = exit_ok;
  std::vector<std::string> reasons;  ///< a sentence for each row that led to it
};

/// `asked_backends` and `asked_integrators`: by name.
BenchVerdict verdict_of(const std::vector<ResultRow>& rows, const std::vector<std::string>& asked_backends,
                        const std::vector<std::string>& asked_integrators);

/// Traces every combination whose row is ok, from the start over as many steps as it was verified with, into
/// FOLDER/STEM.h5, `stems` being those of the rows' files: what `mssim bench --trace` does after the timing.
/// Files that are there already stay when `keep_existing`. `provenance`: the bench's. Ends between two traces
/// when it is asked to. A row has failed where the program behind its backend fails now; returns whether one
/// has. Throws WriteError.
bool write_bench_traces(const SceneJob& job, const PreparedScene& scene, std::vector<ResultRow>& rows,
                        const std::vector<std::string>& stems, const Provenance& provenance,
                        const std::filesystem::path& folder, bool keep_existing, const BenchWatch& watch);

/// Shares a bench's time out among its scenes, so that all get about as many rounds.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts now. No `seconds` is no limit. Throws UsageError when the time is not enough for one round of
  /// each scene.
  TimeBudget(std::optional<double> seconds, std::vector<ExpectedTime> scenes);

  /// When all is to have ended; none without a limit.
  std::optional<Clock::time_point> end() const { return end_; }
  /// When the next scene, which begins now, is to have been measured and checked; none without a limit.
  std::optional<Clock::time_point> begin_scene();
  /// The scene's first round has ended, which tells how far to believe what was expected.
  void first_round_done();

 private:
  std::optional<Clock::time_point> end_;
  std::vector<ExpectedTime> scenes_;  ///< those that have not begun
  ExpectedTime present_;
  Clock::time_point present_start_;
  double expected_ = 0, taken_ = 0;  ///< seconds up to the first round, of all scenes so far
};

/// Builds and measures the plan's timed scenes, one after the other, but for what the results have of them
/// already, and keeps the rows after every round. With --trace traces each scene behind its measurement. Ends
/// early when it is asked to. Throws like UnbuiltScene::prepare, BenchResults::keep and write_bench_traces.
void measure_scenes(BenchPlan& plan, TimeBudget& budget, const StopRequest& stop, BenchResults& results);

}  // namespace mssim
