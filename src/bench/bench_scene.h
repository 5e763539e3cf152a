#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/job/job.h"

namespace mssim {

/// What bench_scene tells and asks between measurements, never inside one.
struct BenchWatch {
  /// What is under way, and how much of the scene is done, 0 to 1.
  std::function<void(const std::string& activity, double done)> progress;
  /// The rows with the samples of all rounds so far, so that they can be kept.
  std::function<void(const std::vector<ResultRow>& rows)> after_round;
  /// Whether to end now. Samples of a round that is not complete are lost.
  std::function<bool()> stop;
};

/// Verifies and times all combinations of a scene.
///
/// Timing: after a verification of each combination, `rounds` rounds, each of which takes one sample of every
/// combination in a random order, so that the drift of a noisy machine hits all alike. A sample is as many
/// steps as fill `sample_seconds`, and no more than can be checked. It starts from the scene's start state
/// with a wave of the round's own (sample_start), which is set, and where steps take less than 10 ms warmed
/// up with a step, outside the timed region. Speed-ups are medians of the ratios within a round.
///
/// The samples of one round, which nobody can foresee, are compared with the reference after the last round
/// (check_samples): a row that was right in the verification and is wrong in its samples has failed. One
/// whose program takes its steps when the state is asked for has failed, too (require_prompt_steps).
///
/// A garment is first dressed by each backend, and how it fits then decides with the comparison whether the
/// row is verified. Its samples start from one draped, settled state (draped_state), in which it touches the
/// body, and are not checked: only mssim's own backends have garments. Those of a cloth that is seen in
/// windows start from the scene's start, and all are compared in the windows.
///
/// With job.verified nothing is verified, dressed or held against the machine's peaks again: combinations are
/// right or wrong as those rows say, and samples are taken of the right ones.
///
/// Rounds of which all combinations have an earlier sample are not measured again; what an earlier run did
/// beyond them is dropped.
///
/// Returns one row a combination, integrators outermost; what cannot run or is wrong has a row with the
/// reason. Where it was asked to stop, the rows have the rounds that were complete; none, if there was not
/// one.
std::vector<ResultRow> bench_scene(const SceneJob& job, const BenchWatch& watch);

}  // namespace mssim
