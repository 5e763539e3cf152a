#pragma once

#include <cstdint>
#include <vector>

#include "bench/bench_memory.h"
#include "bench/expected_time.h"
#include "bench/job/scene_job.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What the memory and the time of a scene with these counts depend on.
SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts);

/// A scene that a bench is to time, before it is built.
struct PlannedScene {
  SceneSpec spec;
  SceneSize size;
  std::uint64_t memory_bytes = 0;  ///< bench_memory_needed
  ExpectedTime time;
};

/// Throws SceneError where the scene needs more memory than there is: a user shall not wait for a scene only
/// to see the program killed. Throws like counts_of.
PlannedScene planned_scene(SceneSpec spec, const BenchSettings& settings);

/// The times of the scenes alone.
std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes);

}  // namespace mssim
