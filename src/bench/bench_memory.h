#pragma once

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

/// Bytes that bench_scene takes at its peak for a scene of this size, about: the System; all combinations of
/// the scene, because every round takes a sample of each; and the larger of what the reference and what a
/// verification needs beside them; of a garment also the states that its reference keeps.
std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size);

}  // namespace mssim
