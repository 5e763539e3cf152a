#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "garment/body/body_profile.h"
#include "garment/fitting/fitting.h"
#include "integrators/stability.h"
#include "model/system.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// A scene ready to be stepped.
struct PreparedScene {
  SceneSpec spec;
  System system;
  SceneCounts counts;
  double dt_s = 0;  ///< the scene's, or the largest safe one for `auto`
  /// How the scene differs from what its file states, and what of a body a garment ignores; or empty.
  std::string note;
  std::shared_ptr<const MeasuredBody> body;  ///< that a garment is put on; none of other scenes
};

/// Builds the scene of its parts. Throws SceneError.
PreparedScene prepare_scene(SceneSpec spec, const SceneParts& parts);

/// Prepares a scene whose parts are read for it alone. Throws SceneError and MissingProgram.
PreparedScene prepare_scene(SceneSpec spec);

/// The modes of the scene, for the stability limits of its integrators.
ModeBound mode_bound(const System& system);

/// Says the note, if there is one, on stderr.
void warn_of_note(const PreparedScene& scene);

/// Sets scene_as_shipped of rows that were measured with scenes of these hashes; the others have no published
/// time.
void mark_own_scenes(std::vector<ResultRow>& rows, const Provenance& measured);

/// A body to measure fits against: the mesh of its trunk and legs, which is what garments meet; for how far
/// cloth stands off, all of it.
FitBody fit_body(const std::shared_ptr<const MeasuredBody>& body);

}  // namespace mssim
