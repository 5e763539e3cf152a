#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "bench/job/job.h"
#include "bench/verification/verification.h"

namespace mssim {

/// A stretch of the reference's way, so short that a backend that is right stays beside it.
struct GarmentStretch {
  State start;
  State end;
};

/// The yardstick for every backend that dresses a garment: verification_steps from its start, while its seams
/// close, and as many from where it hangs draped, in stretches that each begin anew where the reference was.
struct GarmentReference {
  std::vector<GarmentStretch> seaming;
  std::vector<GarmentStretch> draped;
  double tolerance = 0;                ///< on what a stretch's roundings may move, in mean rest lengths
  double farthest = 0;                 ///< on any one node of a draped stretch, in mean rest lengths
  std::optional<std::string> failure;  ///< why there is no reference
};

/// Steps of a stretch, and how many there are of each kind.
inline constexpr int stretch_steps = 5;
inline constexpr int stretches = verification_steps / stretch_steps;

/// Runs the reference. A draped stretch begins with a wave on top of the settled garment's velocities, so
/// that friction, damping and the correction of elongations have something to do. `draped` is a state of the
/// system, at rest and draped.
///
/// Why stretches: a spring is corrected from one elongation on, and contact begins at one depth. A rounding
/// that decides otherwise moves a node as far as the law does, and its neighbours follow: over 100 steps in
/// one go single precision ends anywhere from 1e-5 to 0.3 of a rest length away, as far as a wrong backend.
/// Over five steps few nodes are hit, and seldom the same one again.
/// - While seams close, each node's error is the median over the stretches, so that one that is hit now and
///   then does not count and one with a wrong force, which errs in all, does. The largest must stay below
///   the tolerance of five steps (position_tolerance): 4 sqrt(5) = 8.9 u |x|, where u = 2^-24. Float backends
///   show 1.1 to 1.4 u |x| on jeans of 1,000 to 64,000 nodes. On those of 4,000, whatever is 1 % off shows 17
///   (bending springs of one panel) to 104 (the seams' force), a missing spring 190, a missing joint 4,000.
/// - Draped, whoever touches the body lies just where contact begins, and a median says nothing. Of all
///   errors of all stretches, half must stay below a random walk of roundings, a quarter of the tolerance,
///   where float backends show 0.3 u |x| and damping 10 % off 7; nine tenths below the tolerance, where they
///   show 0.7 to 1, friction 10 % off 120, and a correction left out 290. None may exceed what contact,
///   deciding otherwise in every step, would move a node: the speed at which it moves nodes out, times the
///   stretch's time, 5,600 to 43,000; they show 400 to 1,900.
/// tests/garment/bench/garment_bench_test.cpp proves that such mistakes are found.
///
/// `backend`: the algorithm in double precision.
GarmentReference run_garment_reference(Backend& backend, const System& system, const Integrator& integrator,
                                       double dt_s, const State& draped);

/// Steps the backend, which dresses, and compares. The position error is the larger of those that are held
/// against the tolerance; the drift that of the sum over all stretches. Leaves the backend in any state.
Verification verify_garment(Backend& backend, const System& system, const GarmentReference& reference,
                            double dt_s);

/// The job's garment, dressed and settled, by the backend that is the same to the last bit for any number of
/// threads; where it does not settle, where the longest time has left it. None when it was asked to stop.
std::optional<State> draped_state(const SceneJob& job, const std::function<bool()>& stop);

/// Dresses the job's garment with the combination's backend and keeps how that went; where an earlier row has
/// it already, keeps that. The row has failed where a number of the fit is out of bounds or not finite; one
/// of a published algorithm is noted instead, because what a paper's method does is a result, too. Returns
/// false when it was asked to stop.
bool dress_combination(Combination& combination, const SceneJob& job, const BackendInfo& info,
                       const std::function<bool()>& stop);

}  // namespace mssim
