#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "bench/results/result.h"
#include "bench/verification/reference_cache.h"
#include "bench/verification/verification.h"
#include "bench/windows/windows.h"
#include "garment/fitting/fitting.h"

namespace mssim {

/// How long samples and warm-ups are.

/// A sample takes at most this many steps, so that a fast backend does not simulate far into another regime
/// (the floor) than a slow one.
inline constexpr int max_sample_steps = 2000;

/// A sample is at least so many times as long as the clock's smallest step, which is then a thousandth of it.
inline constexpr double least_clock_steps = 1000;

/// The smallest step of the steady clock that can be seen, in seconds: of a thousand readings in a row.
double clock_resolution_s();

/// Steps of a sample that is to take `sample_seconds`, when one step takes `step_seconds`: at least 1, and at
/// most `most` unless those were too short for the clock.
int sample_steps(double step_seconds, double sample_seconds, double clock_resolution_seconds,
                 int most = max_sample_steps);

/// Trials before a backend counts as warm, whatever they say.
inline constexpr int most_warm_up_trials = 20;

/// Whether trials of equal length, in seconds and in their order, show that the backend is warm: the last two
/// were not faster than the fastest before them, but for 2 %. A cold one (page faults, frequency, a driver
/// that still compiles) becomes faster from trial to trial.
bool is_warm(std::span<const double> trial_seconds);

/// What a garment needs beside its System.
struct GarmentJob {
  FitBody body;
  FitBounds bounds = {};
  SettlingRule rule = {};
};

/// How to measure, whatever the scene: every backend with every integrator.
struct BenchSettings {
  std::vector<const BackendInfo*> backends;
  std::vector<const Integrator*> integrators;
  ExecutionOptions execution;
  int rounds = 0;                   ///< at most, with a deadline
  std::optional<int> windows = {};  ///< a cloth is verified in so many, and nobody builds the whole
  double sample_seconds = 0.1;      ///< what a sample's steps should add up to
  std::optional<ReferenceCache> references = {};  ///< none: references are not kept for later runs
  /// Where an earlier process of the same program has verified every combination: its rows, which tell which
  /// are right. Then samples are taken and nothing else is done.
  std::optional<std::vector<ResultRow>> verified = {};
};

/// Combinations of a scene: integrators outermost.
inline std::size_t combinations(const BenchSettings& settings) {
  return settings.integrators.size() * settings.backends.size();
}

/// What to measure of one scene.
struct SceneJob : BenchSettings {
  std::string name = {};
  const System* system = nullptr;
  std::optional<std::uint64_t> springs_published = {};
  std::string note = {};                   ///< for every row
  std::optional<GarmentJob> garment = {};  ///< of a garment: it is dressed, too, and timed as it hangs draped
  /// Where nobody has the whole cloth: `system` is an outline then, and all backends have windows.
  std::optional<WindowedCloth> windowed = {};
  double dt_s = 0;
  /// No round begins after which the samples would probably not have been checked before it, but for the
  /// first.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  /// The share of the whole that what precedes the rounds takes, about: for the progress only.
  double preparation = 0.3;
  std::vector<ResultRow> earlier = {};  ///< rows of the same combinations, whose samples are kept
};

/// A row under way: a backend with an integrator on the job's scene.
struct Combination {
  ResultRow row;
  const Integrator* integrator = nullptr;
  bool on_host = true;
  int steps_per_pass = 0;
  std::optional<std::uint64_t> stored_springs;
  const State* start = nullptr;         ///< of every sample of a round
  std::unique_ptr<Backend> backend;     ///< null where the row has no times: it cannot run, or has failed
  DressingBackend* dressing = nullptr;  ///< the same, of a garment
  WindowBackend* windows = nullptr;     ///< the same, of a cloth that is seen in windows
  int steps_taken = 0;                  ///< from the scene's start, before it is verified
  int steps = 1;                        ///< in a sample
  int most_steps = max_sample_steps;    ///< in a sample, so that its end can be compared with the reference
  std::vector<double> processors;       ///< that each sample of this run took: processor seconds a second
  std::vector<Communication> communication;  ///< in each sample of this run, where the backend tells it
  double step_seconds = 0;                   ///< what calibrate has found; 0 before
  std::vector<double> sample_seconds,
      reading_seconds;  ///< of this run: of samples, and of reading their ends
  /// What reading the state takes after one step, from the first sample on that was read for longer than it
  /// took; none before.
  std::optional<double> step_reading_seconds;
  std::optional<SampleEnd> checked;  ///< the end of the sample that is to be checked
  /// What the windows say after so many steps, of a cloth that is seen in windows; empty where it was
  /// verified by an earlier process.
  std::function<Verification(WindowBackend& backend, int steps)> compare_windows;
};

/// Makes the backend; a reason not to becomes the row's status. `start`: of its samples; must
/// outlive it.
Combination make_combination(const SceneJob& job, const BackendInfo& info, const Integrator& integrator,
                             const State& start);

/// Ends the combination with a reason, and keeps what a program behind it wrote.
void fail(Combination& combination, const std::string& status);

/// Ends the backend of a combination that is measured, and keeps what it has come to say on the way and what
/// a program behind it wrote.
void end(Combination& combination);

/// Where the backend's times would mean nothing: ends it, and the row says why. Verified it stays.
void leave_untimed(Combination& combination);

/// Does something with the combination's backend; the row has failed where the program behind it fails.
void attempt(Combination& combination, const std::function<void()>& work);

/// Takes what a comparison with the reference has found. The row has failed where it is not near enough.
void take_verification(Combination& combination, const Verification& verification);

/// Takes over what an earlier process has found, and notes it in the row. The row has failed where it had
/// failed there, or where what was verified there is not what runs here.
void take_verification(Combination& combination, const std::vector<ResultRow>& verified);

/// Finds how many steps fill a sample, from ever longer trials, and goes on until the backend is warm. With
/// job.verified the first trial of a tenth of a sample decides, and the first samples warm the backend up:
/// the processes that are only sampled are many and short, and each counts with its least sample. The backend
/// rests afterwards.
void calibrate(Combination& combination, const SceneJob& job);

/// Milliseconds a step, in a sample of combination.steps from their start. Sets and warms up what is
/// needed outside the timed region, after which the backend rests. The row has failed where the result is not
/// finite, and where the program behind the backend fails: then there is no sample.
/// `first`: where the sample's end is to be checked, the node to look at first (sample_end).
std::optional<double> sample_ms(Combination& combination, const SceneJob& job,
                                std::optional<std::size_t> first);

/// Fails the combination where its samples show that steps are not taken while the clock runs, but when the
/// state is asked for: reading it then takes the longer, the more steps there were.
void require_prompt_steps(Combination& combination);

/// Computes all that follows from the row's samples. `serial`: the baseline's row of the same integrator, or
/// null.
void summarise(ResultRow& row, const ResultRow* serial);

/// Takes numbers that are not finite out of the row, as a program may have told some that lead to them or
/// have taken no time that a clock sees. A row that was ok has failed by the first of them.
void require_finite(ResultRow& row);

/// Adds to the row what the samples of this run took beside time: processors, and communication.
void summarise_costs(const Combination& combination, ResultRow& row);

}  // namespace mssim
