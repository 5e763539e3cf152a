#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "bench/job/job.h"
#include "bench/verification/verification.h"

namespace mssim {

/// A short stretch of the reference's trajectory, over which a correct backend stays close to it.
struct GarmentStretch {
  State start;
  State end;
};

/// The reference for every backend that dresses a garment: verification_steps from its start, while its seams
/// close, and as many from its draped state. Each stretch starts from a state of the reference.
struct GarmentReference {
  std::vector<GarmentStretch> seaming;
  std::vector<GarmentStretch> draped;
  double tolerance = 0;  ///< on deviations by rounding over a stretch, in mean rest lengths
  double farthest = 0;   ///< largest deviation of any node of a draped stretch, in mean rest lengths
  std::optional<std::string> failure;  ///< why there is no reference
};

/// Steps per stretch, and number of stretches of each kind.
inline constexpr int stretch_steps = 5;
inline constexpr int stretches = verification_steps / stretch_steps;

/// Runs the reference. A draped stretch starts with a wave added to the settled garment's velocities, so that
/// friction, damping and the correction of elongations act. `draped` is a state of the system, at rest and
/// draped.
///
/// Stretches are short because the correction of springs and contact have thresholds. A rounding error that
/// changes such a decision moves a node as far as the law does, and its neighbours follow. Over 100
/// consecutive steps, single precision ends 1e-5 to 0.3 of a rest length away, as far as a wrong backend.
/// Over five steps, this affects few nodes, and seldom the same one again. Errors below are in u |x|, where u
/// = 2^-24.
/// - While seams close, the error of a node is its median over the stretches. So an occasional changed
///   decision does not count, but a wrong force, which errs in all stretches, does. The largest error must
///   stay below the tolerance of five steps (position_tolerance), 4 sqrt(5) = 8.9. Float backends show 1.1 to
///   1.4 on jeans of 1,000 to 64,000 nodes. On those of 4,000, a force 1 % off shows 17 (bending springs of
///   one panel) to 104 (seams), a missing spring 190, a missing joint 4,000.
/// - In the draped state, nodes that touch the body lie at the threshold of contact, so that a median is
///   useless. Half of all errors of all stretches must stay below a random walk of roundings, a quarter of
///   the tolerance: float backends show 0.3, damping 10 % off 7. Nine tenths must stay below the tolerance:
///   float backends show 0.7 to 1, friction 10 % off 120, an omitted correction 290. None may exceed the
///   distance that contact moves a node if it decides otherwise in every step (its push speed times the
///   stretch's time, 5,600 to 43,000): float backends show 400 to 1,900.
/// tests/garment/bench/garment_bench_test.cpp checks that such mistakes are found.
///
/// `backend`: the algorithm in double precision.
GarmentReference run_garment_reference(Backend& backend, const System& system, const Integrator& integrator,
                                       double dt_s, const State& draped);

/// Steps the dressing backend, and compares. The position error is the largest of those that are compared
/// with the tolerance; the drift is of the sum over all stretches. Leaves the backend in an unspecified
/// state.
Verification verify_garment(Backend& backend, const System& system, const GarmentReference& reference,
                            double dt_s);

/// The job's garment, dressed until it settles or the longest time is over, with the backend that is bitwise
/// identical for every number of threads. None if it was stopped.
std::optional<State> draped_state(const SceneJob& job, const std::function<bool()>& stop);

/// Dresses the job's garment with the combination's backend and stores the outcome in its row; an earlier
/// row's outcome is kept. The row fails if a number of the fit is out of bounds or not finite. A published
/// algorithm gets a note instead, because the outcome of a paper's method is a result. Returns false if it
/// was stopped.
bool dress_combination(Combination& combination, const SceneJob& job, const BackendInfo& info,
                       const std::function<bool()>& stop);

}  // namespace mssim
