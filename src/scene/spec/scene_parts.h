#pragma once

#include <functional>
#include <optional>

#include "scene/spec/built_scene.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What a scene is built from. All files that its own file names have been read, each once, and made into
/// meshes, or into a measured body and the garment that is cut for it; none is read again.
///
/// Copies share the meshes, of which there is one each. Estimates of memory do not count them: who has built
/// the scene for the last time drops its parts.
struct SceneParts {
  SceneCounts counts;                 ///< what the scene has
  std::optional<SceneCounts> stated;  ///< what files say about that, none where they say nothing
  /// Builds the scene, whose spec they were read for. Throws SceneError when it needs more memory than there
  /// is, before allocating any for its System, and for what does not fit together.
  std::function<BuiltScene(const SceneSpec& spec)> build;
};

}  // namespace mssim
