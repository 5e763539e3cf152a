#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "bench/results/result.h"
#include "bench/windows/windowed_cloth.h"
#include "garment/fitting/fit_bounds.h"

namespace mssim {

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
  /// No round begins that would probably not end before it, but for the first.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  /// The share of the whole that what precedes the rounds takes, about: for the progress only.
  double preparation = 0.3;
  std::vector<ResultRow> earlier = {};  ///< rows of the same combinations, whose samples are kept
};

}  // namespace mssim
