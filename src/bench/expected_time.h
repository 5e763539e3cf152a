#pragma once

#include "bench/bench_memory.h"
#include "bench/scene_job.h"

namespace mssim {

/// How long bench_scene takes, in seconds.
struct ExpectedTime {
  double preparation = 0;  ///< building the scene, references, verification, calibration, peaks
  double round = 0;        ///< one sample of every combination
};

/// The time for a scene of this size, about: by a factor of two either way, because it takes all processors
/// and backends for alike. A plan is made of it, no result. Of the job, the scene's own part is not looked
/// at.
ExpectedTime expected_time(const SceneJob& job, const SceneSize& size);

}  // namespace mssim
