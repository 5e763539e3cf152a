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

/// Exit code of a bench, with reasons.
struct BenchVerdict {
  /// 1 if a measured row is wrong; 3 if a backend or integrator that was requested by name could not run.
  ExitCode exit_code = exit_ok;
  std::vector<std::string> reasons;  ///< a sentence for each row that caused it
};

/// The verdict on `rows`. `asked_backends` and `asked_integrators` are those requested by name.
BenchVerdict verdict_of(const std::vector<ResultRow>& rows, const std::vector<std::string>& asked_backends,
                        const std::vector<std::string>& asked_integrators);

/// Traces every combination whose row is ok, from the start for as many steps as in the verification, into
/// FOLDER/STEM.h5 with the rows' `stems`: the work of `mssim bench --trace` after the timing. Existing files
/// stay if `keep_existing`. `provenance`: the bench's. Stops between two traces on request. A row fails if
/// its program fails now; returns whether one did. Throws WriteError.
bool write_bench_traces(const SceneJob& job, const PreparedScene& scene, std::vector<ResultRow>& rows,
                        const std::vector<std::string>& stems, const Provenance& provenance,
                        const std::filesystem::path& folder, bool keep_existing, const BenchWatch& watch);

/// Divides the time of a bench among its scenes, so that all get about as many rounds.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts now. Without `seconds` there is no limit. Throws UsageError if the time is too short for one
  /// round of each scene.
  TimeBudget(std::optional<double> seconds, std::vector<ExpectedTime> scenes);

  /// Gives the time of a scene that has not begun, the `scene`-th from now, to the others: nothing of it is
  /// measured.
  void skip(std::size_t scene) { scenes_[scene] = {}; }
  /// When everything must have ended; none without a limit.
  std::optional<Clock::time_point> end() const { return end_; }
  /// When the next scene, which begins now, must have been measured and checked; none without a limit.
  std::optional<Clock::time_point> begin_scene();
  /// Must be called after the scene's first round. Its time and that of the preparation correct the
  /// expectations. Returns the scene's corrected deadline.
  std::optional<Clock::time_point> first_round_done();

 private:
  std::optional<Clock::time_point> deadline() const;

  std::optional<Clock::time_point> end_;
  std::vector<ExpectedTime> scenes_;  ///< those that have not begun
  ExpectedTime present_;              ///< what remains of the present scene
  Clock::time_point present_start_;
  double expected_ = 0, taken_ = 0;  ///< seconds before the first round, for all scenes so far
};

/// Builds and measures the plan's timed scenes one by one, except for rounds that the results already have,
/// and keeps the rows after every round. With --trace, traces each scene after its measurement. Stops early
/// on request. Returns a sentence for each scene for which there is no memory any more; if it is the only
/// one, throws SceneError. Throws like UnbuiltScene::prepare, BenchResults::keep and write_bench_traces.
std::vector<std::string> measure_scenes(BenchPlan& plan, TimeBudget& budget, const StopRequest& stop,
                                        BenchResults& results);

}  // namespace mssim
