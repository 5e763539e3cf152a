#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/job/job.h"

namespace mssim {

/// Callbacks that bench_scene makes between measurements, never during one.
struct BenchWatch {
  /// Receives the current activity and the finished share of the scene, 0 to 1.
  std::function<void(const std::string& activity, double done)> progress;
  /// Receives the rows with the samples of all rounds so far, to be kept; their note is `unchecked_samples`.
  std::function<void(const std::vector<ResultRow>& rows)> after_round;
  /// Returns whether to stop now. Samples of an incomplete round are lost.
  std::function<bool()> stop;
};

/// Verifies and times all combinations of a scene.
///
/// Timing: after each combination has been verified, `rounds` rounds follow. A round takes one sample of
/// every combination, in random order, so that the drift of a noisy machine affects all of them. A sample has
/// as many steps as fill `sample_seconds`, but no more than can be checked. It starts from the scene's start
/// state with a wave that differs from round to round (sample_start). Outside the timed region the state is
/// set and, if steps take less than 10 ms, one warm-up step is taken. Speed-ups are medians of the ratios
/// within a round.
///
/// The samples of one round, which programs cannot predict, are compared with the reference after the last
/// round (check_samples). A row that passed the verification but has a wrong sample has failed. So has a row
/// whose program takes its steps only when the state is requested (require_prompt_steps).
///
/// Each backend first dresses a garment; the fit and the comparison decide whether the row is verified.
/// Samples of a garment start from one draped, settled state (draped_state), in which it touches the body.
/// They are not checked, because only mssim's own backends support garments. Samples of a cloth that is
/// verified in windows start from the scene's start state, and all of them are compared in the windows.
///
/// With job.verified, nothing is verified, dressed or compared with the machine's peaks. The rows of
/// job.verified decide which combinations are right, and only these are sampled.
///
/// Rounds for which every combination has an earlier sample are not measured again. Earlier samples of other
/// rounds are dropped. If no round is left to measure, the samples of one more round are checked, and their
/// times do not count.
///
/// Returns one row per combination, integrators outermost. The row of a combination that cannot run or is
/// wrong has the reason. If stopped, the rows have the samples of the complete rounds, and the note
/// `unchecked_samples`; there are no rows if it was stopped during the preparation or the first round.
std::vector<ResultRow> bench_scene(const SceneJob& job, const BenchWatch& watch);

}  // namespace mssim
