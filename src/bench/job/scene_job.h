#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "bench/results/result.h"
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

}  // namespace mssim
