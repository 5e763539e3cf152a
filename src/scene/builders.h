#pragma once

#include <cstdint>
#include <filesystem>

#include "model/system.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The nodes of a window as a cloth of their own, with the numbers that they have in the whole: what lies
/// outside is not built. Its springs are left out: springs_of (model/system.h) gives them. Throws
/// std::bad_alloc.
System build_cloth_window(const SceneSpec& spec, const GridWindow& window);

/// What can be known of the cloth without any of its nodes: all but their masses, pins, springs and start.
System outline_of_cloth(const SceneSpec& spec);

/// The cloth as spec describes it: node (r, c) has the index r * columns + c and starts at
/// (c spacing, ceiling height, r spacing) plus the ripple, a standing wave of given amplitude in position and
/// velocity. Pinned nodes are not displaced. Deterministic. Throws std::bad_alloc.
System build_cloth(const SceneSpec& spec);

/// Bytes that any run of a scene of this size needs at least: its System with the start state, and the
/// double-precision reference that every run is compared with (up to four pairs of position and velocity),
/// and one state read back. The backend under test comes on top.
std::uint64_t memory_needed(const SceneCounts& counts);

/// Nodes and springs that the mesh of a body of that shape has at least, without making it; zero where that
/// is not known. The scene file is in that folder. Throws SceneError where the shape is another scene's, and
/// there is no such scene, or it cannot be used.
SceneCounts least_counts(const BodyShape& shape, const std::filesystem::path& folder);

}  // namespace mssim
