#pragma once

#include <cstdint>
#include <optional>

#include "model/system.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The row "cloth" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_cloth_fields need a spec whose content is a ClothSpec.

void visit_cloth_fields(FieldVisitor& fields, SceneSpec& spec);

/// The nodes can be numbered, the pinned row exists, the cloth starts above the floor, and the ripple folds
/// no spring to length zero. Throws SceneError.
void check_cloth(const SceneSpec& spec);

/// A cloth is as its file says.
std::optional<SceneCounts> stated_cloth_counts(const SceneSpec& spec);

/// There is nothing to read: a cloth names no files.
SceneParts read_cloth(const SceneSpec& spec);

/// The nodes of a window as a cloth of their own, with the numbers that they have in the whole: what lies
/// outside is not built. Its springs are left out: springs_of (model/topology.h) gives them. Throws
/// std::bad_alloc.
System build_cloth_window(const SceneSpec& spec, const GridWindow& window);

/// What can be known of the cloth without any of its nodes: all but their masses, pins, springs and start.
System outline_of_cloth(const SceneSpec& spec);

/// The cloth as spec describes it: node (r, c) has the index r * columns + c and starts at
/// (c spacing, ceiling height, r spacing) plus the ripple, a standing wave of given amplitude in position and
/// velocity. Pinned nodes are not displaced. Deterministic. Throws SceneError when the memory does not
/// suffice.
System build_cloth(const SceneSpec& spec);

}  // namespace mssim
