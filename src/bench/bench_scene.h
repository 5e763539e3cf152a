#pragma once

#include <functional>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "bench/result.h"

namespace mssim {

/// What to measure of one scene: every backend with every integrator.
struct SceneJob {
  std::string name;
  const System* system = nullptr;
  std::uint64_t springs_published = 0;
  std::string note = {};  ///< for every row
  double dt_s = 0;
  std::vector<const BackendInfo*> backends;
  std::vector<const Integrator*> integrators;
  ExecutionOptions execution;
  int rounds = 0;
  double sample_seconds = 0.1;  ///< what a sample's steps should add up to
};

/// A sample takes at most this many steps, so that a fast backend does not simulate far into another regime
/// (the floor) than a slow one.
inline constexpr int max_sample_steps = 2000;

/// Called between measurements, never inside one: what is under way, and how much of the scene is done, 0
/// to 1.
using Progress = std::function<void(const std::string& activity, double done)>;

/// Verifies and times all combinations of a scene.
///
/// Timing: after a verification of each combination, `rounds` rounds, each of which takes one sample of every
/// combination in a random order, so that the drift of a noisy machine hits all alike. A sample is as many
/// steps as fill `sample_seconds`, from the scene's start state, which is set, and warmed up with a step,
/// outside the timed region. Speed-ups are medians of the ratios within a round.
///
/// Returns one row a combination, integrators outermost; what cannot run or is wrong has a row with the
/// reason.
std::vector<ResultRow> bench_scene(const SceneJob& job, const Progress& progress);

}  // namespace mssim
