#pragma once

#include <cstdint>
#include <vector>

#include "bench/estimates.h"
#include "bench/job/scene_job.h"
#include "commands/shared/prepared_scene.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What the memory and the time of a scene with these counts depend on.
SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts);

/// A scene before a bench builds it. Its parts are read for the plan and dropped when the scene has been
/// built, so that they take no memory while it is measured; what those of some scenes take meanwhile is not
/// available to those that are planned after them, which are refused where it is missing.
struct UnbuiltScene {
  SceneSpec spec;
  SceneParts parts;

  /// Builds the scene, for the last time, and drops the parts. Throws SceneError.
  PreparedScene prepare();
};

/// A scene that a bench is to time.
struct PlannedScene : UnbuiltScene {
  std::vector<const BackendInfo*> backends;  ///< that are measured on it
  SceneSize size;
  std::uint64_t memory_bytes = 0;  ///< bench_memory_needed
  ExpectedTime time;
  std::vector<GridWindow> windows;  ///< in which it is verified and nobody here builds the whole; or none
};

/// A cloth whose backends all have windows gets some where they are asked for, or where the whole does not
/// fit. Throws UsageError where they are asked for and cannot be had. Throws SceneError where the scene needs
/// more memory than there is: a user shall not wait for a scene only to see the program killed.
PlannedScene planned_scene(UnbuiltScene scene, const BenchSettings& settings);

/// What is prepared of a scene that is verified in windows: no node of it.
PreparedScene outline_of(const PlannedScene& planned);

/// A window of a cloth with its springs.
System build_window(const SceneSpec& spec, const GridWindow& window);

/// The times of the scenes alone.
std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes);

}  // namespace mssim
