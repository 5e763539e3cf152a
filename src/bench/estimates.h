#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bench/job/job.h"

namespace mssim {

/// The size of a scene, before it is built.
struct SceneSize {
  std::uint64_t nodes = 0;
  std::uint64_t springs = 0;  ///< unique ones
  bool grid = false;          ///< a cloth, else bodies or a garment
  bool garment = false;
};

/// How many references bench_scene runs at the same time, at most.
std::size_t references_at_once(const BenchSettings& settings);

/// Bytes that bench_scene takes at its peak for a scene of this size, about: the System, and the larger of
/// what the references need and of what follows: all combinations of the scene, because every round takes a
/// sample of each, what the references have left, and one verification. Of a garment a reference leaves more
/// states. The check of samples is left out: it follows when the backends have gone, and takes a second
/// reference only of scenes of up to a million nodes.
std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size);

/// How long bench_scene takes, in seconds.
struct ExpectedTime {
  double preparation = 0;  ///< building the scene, references, verification, dressing, calibration, peaks
  double round = 0;        ///< one sample of every combination
  double check = 0;        ///< after the last round: the ends of samples

  double with(double rounds) const { return preparation + rounds * round + check; }
};

/// Force evaluations that a step takes as long as: of an implicit integrator about, at a dt near its limits
/// of use, because its solver goes on for as long as it takes.
double expected_evaluations(const Integrator& integrator);

/// The time of several scenes together.
ExpectedTime total(std::span<const ExpectedTime> scenes);

/// How many rounds of them fit into `seconds` with all else, at least 1.
double rounds_within(double seconds, const ExpectedTime& time);

/// The time for a scene of this size, about: by a factor of two either way, because it takes all processors
/// for alike. A plan is made of it, no result.
ExpectedTime expected_time(const BenchSettings& settings, const SceneSize& size);

/// Steps of a sample whose end is compared with the reference, at most: the reference of so many, and what
/// roundings make of it, shall take some seconds, or no longer than the verification.
int checkable_steps(const Integrator& integrator, const SceneSize& size);

/// Seconds that simulating `steps` steps takes a backend, as roughly; dressing a garment takes as many as it
/// needs, but no more. Building the scene is part of it, writing files is not.
double expected_run_time(const BackendInfo& backend, const Integrator& integrator, const SceneSize& size,
                         double steps);

}  // namespace mssim
