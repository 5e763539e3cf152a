#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "garment/body/body_profile.h"
#include "garment/fitting/fitting.h"
#include "model/system.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// A scene ready to be stepped.
struct PreparedScene {
  SceneSpec spec;
  System system;
  SceneCounts counts;
  double dt_s = 0;  ///< the scene's, or the largest safe one for `auto`
  /// Differences between the scene and its file, and the parts of a body that a garment ignores; may be
  /// empty.
  std::string note;
  std::shared_ptr<const MeasuredBody> body;  ///< on which a garment is dressed; none for other scenes
  std::vector<std::filesystem::path> files;  ///< from which it was read (SceneParts)
};

/// Builds the scene from its parts. Throws SceneError.
PreparedScene prepare_scene(SceneSpec spec, const SceneParts& parts);

/// Prepares a scene, reading its parts. Throws SceneError and MissingProgram.
PreparedScene prepare_scene(SceneSpec spec);

/// Throws UsageError if two scenes have one name, by which rows and results are told apart.
void require_distinct_names(const std::vector<SceneSpec>& scenes);

/// Prints the scene's note, if any, to stderr.
void warn_of_note(const PreparedScene& scene);

/// Sets scene_as_shipped of rows that were measured with scenes of these hashes. Only a scene as shipped has
/// a published time.
void mark_own_scenes(std::vector<ResultRow>& rows, const Provenance& measured);

/// A body for measuring fits: the mesh of its trunk and legs, which garments touch; for distances between
/// cloth and body, all of it.
FitBody fit_body(const std::shared_ptr<const MeasuredBody>& body);

}  // namespace mssim
