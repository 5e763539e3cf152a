#pragma once

#include <cstddef>
#include <cstdint>

#include "bench/job/scene_job.h"

namespace mssim {

/// The size of a scene, before it is built.
struct SceneSize {
  std::uint64_t nodes = 0;
  std::uint64_t springs = 0;  ///< unique ones
  bool grid = false;          ///< a cloth, else bodies or a garment
  bool garment = false;
};

/// How many references bench_scene runs at the same time.
std::size_t references_at_once(const BenchSettings& settings);

/// Bytes that bench_scene takes at its peak for a scene of this size, about: the System, and the larger of
/// what the references need and of what follows: all combinations of the scene, because every round takes a
/// sample of each, what the references have left, and one verification. Of a garment a reference leaves more
/// states. The check of samples is left out: it follows when the backends have gone, and takes a second
/// reference only of scenes of up to a million nodes.
std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size);

}  // namespace mssim
