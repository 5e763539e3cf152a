#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bench/job/job.h"

namespace mssim {

/// Size of a scene that has not been built.
struct SceneSize {
  std::uint64_t nodes = 0;
  std::uint64_t springs = 0;  ///< unique ones
  bool grid = false;          ///< a cloth; otherwise bodies or a garment
  bool garment = false;
  int frame_steps = 0;  ///< of a frame, if single frames are timed
};

/// Largest number of references that bench_scene runs at the same time.
std::size_t references_at_once(const BenchSettings& settings);

/// Approximate peak memory of bench_scene for a scene of this size, bytes. It is the System and the larger of
/// two needs: that of the references, and that of the rounds. In the rounds all combinations exist at once,
/// because every round samples each; results of the references and one verification come on top. A garment's
/// reference leaves more states than others. The check of samples is left out: it follows after the backends
/// have been freed, and uses a second reference only for scenes of up to a million nodes.
std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size);

/// Expected time of bench_scene, s.
struct ExpectedTime {
  double preparation = 0;  ///< building the scene, references, verification, dressing, calibration, peaks
  double round = 0;        ///< one sample of every combination
  double check = 0;        ///< after the last round: the ends of samples

  double with(double rounds) const { return preparation + rounds * round + check; }
};

/// Force evaluations that take as long as a step. For an implicit integrator this is an estimate at a dt near
/// its limits of use, because its solver iterates until it converges.
double expected_evaluations(const Integrator& integrator);

/// Total time of several scenes.
ExpectedTime total(std::span<const ExpectedTime> scenes);

/// Number of rounds that fit into `seconds` with preparation and check, at least 1.
double rounds_within(double seconds, const ExpectedTime& time);

/// Expected time of bench_scene for a scene of this size. Accurate to a factor of two, because it assumes
/// equal processors. For planning only.
ExpectedTime expected_time(const BenchSettings& settings, const SceneSize& size);

/// Largest number of steps of a sample whose end is compared with the reference. The references for the check
/// must take no longer than some seconds, or than the verification.
int checkable_steps(const Integrator& integrator, const SceneSize& size);

/// Expected seconds of simulating `steps` steps with a backend, as roughly. For a garment, `steps` is the
/// upper limit of the steps until it has settled. Includes building the scene, but not writing files.
double expected_run_time(const BackendInfo& backend, const Integrator& integrator, const SceneSize& size,
                         double steps);

}  // namespace mssim
