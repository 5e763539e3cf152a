#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "bench/results/result.h"
#include "bench/roofline/roofline.h"
#include "bench/verification/reference_cache.h"
#include "bench/verification/verification.h"
#include "bench/windows/windows.h"
#include "garment/fitting/fitting.h"
#include "platform/counters.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {

/// Lengths of samples and warm-ups.

/// Largest number of steps of a sample. It keeps a fast backend from simulating further than a slow one, into
/// another regime (the floor).
inline constexpr int max_sample_steps = 2000;

/// Least length of a sample, in smallest steps of the clock.
inline constexpr double least_clock_steps = 1000;

/// Number of steps of a sample of about `sample_seconds` if one step takes `step_seconds`: at least 1, and at
/// most `most` unless that is too short for the clock.
int sample_steps(double step_seconds, double sample_seconds, double clock_resolution_seconds,
                 int most = max_sample_steps);

/// Largest number of trials; after them a backend counts as warm.
inline constexpr int most_warm_up_trials = 20;

/// Whether trials of equal length, in s and in order, show that the backend is warm: neither of the last two
/// was more than 2 % faster than the fastest before them. A cold backend (page faults, frequency, a driver
/// that still compiles) becomes faster from trial to trial.
bool is_warm(std::span<const double> trial_seconds);

/// What the job of a garment needs in addition to its System.
struct GarmentJob {
  FitBody body;
  FitBounds bounds = {};
  SettlingRule rule = {};
};

/// How to measure any scene: every backend with every integrator.
struct BenchSettings {
  std::vector<const BackendInfo*> backends;
  std::vector<const Integrator*> integrators;
  ExecutionOptions execution;
  int rounds = 0;               ///< an upper limit if there is a deadline
  double sample_seconds = 0.1;  ///< target length of a sample
  /// Frames per second of simulated time, of which timed_frames are also timed for each row; none: no frames.
  std::optional<double> fps = {};
  std::optional<ReferenceCache> references = {};  ///< none: references are not kept for later runs
  /// Rows of an earlier process of the same program that verified every combination. If set, only samples are
  /// taken, of the combinations that these rows verify.
  std::optional<std::vector<ResultRow>> verified = {};
};

/// Frames of a row that are timed: the 99th percentile is the third largest.
inline constexpr int timed_frames = 300;

/// Largest number of steps of a frame.
inline constexpr double most_frame_steps = 1e9;

/// Steps of `dt_s` (s) in a frame of 1 / `fps` s of simulated time, rounded; at least 1, at most
/// most_frame_steps.
inline int steps_of_frame(double fps, double dt_s) {
  return static_cast<int>(std::clamp(std::round(1 / (fps * dt_s)), 1.0, most_frame_steps));
}

/// Begins the note of a row whose samples are too short for a frame of `steps`.
inline std::string untimed_frames(int steps) {
  return fmt::format("frames of {} are not timed", pluralize(steps, "step"));
}

/// What to measure on one scene.
struct SceneJob : BenchSettings {
  const System* system = nullptr;
  std::optional<std::uint64_t> springs_published = {};
  std::string note = {};  ///< for every row
  /// Set if the scene is a garment: it is dressed, and timed while draped.
  std::optional<GarmentJob> garment = {};
  /// Set if no process builds the whole cloth: `system` is then an outline, and all backends have windows.
  std::optional<WindowedCloth> windowed = {};
  double dt_s = 0;
  /// Except for the first, no round begins if its samples could probably not be checked before the deadline.
  /// BenchWatch::after_round may change it.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  /// Approximate share of the time before the rounds in the whole; for the progress only.
  double preparation = 0.3;
  std::filesystem::path root = "/";                            ///< for PackageEnergy
  EventCounters::Events events = EventCounters::of_processor;  ///< for count_events
  std::vector<ResultRow> earlier = {};  ///< rows of the same combinations, whose samples are kept
};

/// A row in progress: a backend with an integrator on the job's scene.
struct Combination {
  ResultRow row;
  const Integrator* integrator = nullptr;
  bool in_single = true;  ///< if not, its steps move other bytes than the roofline counts, so it gets none
  std::optional<StepCost> cost;         ///< of a step, if that can be counted
  std::optional<MachinePeak> peak;      ///< with which the cost is compared, if it is
  const State* start = nullptr;         ///< start state of every sample of a round
  std::unique_ptr<Backend> backend;     ///< null if the row has no times
  DressingBackend* dressing = nullptr;  ///< the same backend, for a garment
  int steps_taken = 0;                  ///< since the scene's start, before it is verified
  int steps = 1;                        ///< in a sample
  int most_steps = max_sample_steps;    ///< per sample, so that its end can be compared with the reference
  std::vector<double> processors;       ///< processor seconds per second, for each sample of this run
  std::vector<double> joules;           ///< J per step, for each sample of this run, if the system tells
  PackageEnergy energy;
  std::vector<Communication> communication;  ///< for each sample of this run, if the backend reports it
  double step_seconds = 0;                   ///< found by calibrate; 0 before
  std::vector<double> sample_seconds;        ///< wall time of each sample of this run
  std::vector<double> postponed_seconds;     ///< for each sample of this run (TimedState); 0 in windows
  std::vector<SampleEnd> checked;            ///< ends that are to be checked: of a sample, and of frames
  /// Compares the backend's state after this number of steps in the windows; empty if the cloth is not in
  /// windows or was verified by an earlier process.
  std::function<Verification(Backend& backend, const State& state, int steps)> compare_windows;
};

/// Makes the backend and takes one step, for PreparationCosts; if that is impossible, the row's status has
/// the reason. Only one may be made at a time, because MemoryPeak measures the process. `start`: start state
/// of its samples; must outlive the combination.
Combination make_combination(const SceneJob& job, const BackendInfo& info, const Integrator& integrator,
                             const State& start);

/// Ends the combination as failed, with a reason, and keeps the last output of its program.
void fail(Combination& combination, const std::string& status);

/// Ends the backend of a combination, if it has one, and keeps its final note and the output of its program.
void end(Combination& combination);

/// Calls `work` on the combination's backend; the row fails if the backend's program fails.
void attempt(Combination& combination, const std::function<void()>& work);

/// Takes the result of a comparison with the reference. The row fails if that found a failure.
void take_verification(Combination& combination, const Verification& verification);

/// Takes the result of an earlier process, and says so in the row's note. The row fails if it failed there,
/// or if the verified combination differs from this one.
void take_verification(Combination& combination, const std::vector<ResultRow>& verified);

/// Finds the number of steps per sample from trials of growing length, then continues until the backend is
/// warm. With job.verified the first trial of a tenth of a sample decides, and the first samples warm the
/// backend up: processes that only take samples are many and short, and only the least sample of each counts.
/// The backend rests afterwards. It is ended if its times would be meaningless; the row then has the reason
/// and stays verified.
void calibrate(Combination& combination, const SceneJob& job);

/// Takes a sample of combination.steps steps from the start of samples and returns ms per step. Sets the
/// state and warms up outside the timed region; the backend rests afterwards. The row fails if the result is
/// not finite or wrong, or if the backend's program fails; without a measured time the result is empty.
/// `first`: if the sample's end is to be checked, the first node to examine (sample_end).
std::optional<double> sample_ms(Combination& combination, const SceneJob& job,
                                std::optional<std::size_t> first);

/// Times timed_frames frames of 1 / job.fps s of simulated time one after the other, each by itself. Returns
/// to the start of samples before a frame would simulate further than samples may; if even the first one
/// would, the row has a note instead. `first`: if the end of one of these stretches, chosen at random, is to
/// be checked, the first node to examine (sample_end). Ends without a result if `stop` returns true. The row
/// fails if a stretch's end is not finite, or wrong in a window; if the stretches show that steps are not
/// taken while the clock runs (require_prompt_steps); or if the backend's program fails.
void time_frames(Combination& combination, const SceneJob& job, std::optional<std::size_t> first,
                 const std::function<bool()>& stop);

/// Counts the events of job.events in the steps of one more sample, which is not timed because counting takes
/// time, if the system can count them and this process takes the steps.
void count_events(Combination& combination, const SceneJob& job);

/// Fails the combination if its samples show that steps are not taken while the clock runs, but when the
/// state is requested: the more steps there were, the longer reading it then takes. The criterion: reading a
/// sample's end takes longer than reading a state after one step, by more than the sample itself took (low
/// end of the median's interval). If one or two samples show that, more are taken until there are three;
/// their times do not count. Samples of one step, and cloths in windows, are not examined.
void require_prompt_steps(Combination& combination, const SceneJob& job);

/// Adds medians of the other costs of this run's samples to the row: processors, energy, and communication.
void summarise_costs(const Combination& combination, ResultRow& row);

}  // namespace mssim
