#pragma once

#include <array>
#include <filesystem>

#include "model/system.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The nodes of a window as a cloth of their own, with the node numbers of the whole cloth; nodes outside are
/// not built. Has no springs: springs_of (model/system.h) makes them. Throws std::bad_alloc.
System build_cloth_window(const SceneSpec& spec, const GridWindow& window);

/// The system of a cloth without its nodes: without masses, pins, springs and start.
System outline_of_cloth(const SceneSpec& spec);

/// Ratio of the ripple's displacement in the plane to that out of it. A small ripple only out of the plane
/// would strain the springs in second order only.
inline constexpr double ripple_in_plane_share = 0.5;

/// Phases of the ripple's six components along x and z, in radians. A component is zero along lines of
/// constant x and of constant z. No two phases of the velocity on one axis differ by a multiple of pi, so no
/// point is on zero lines of all three, and no node starts at rest.
inline constexpr std::array<std::array<double, 2>, 6> ripple_phases{
    {{0.2, 0.9}, {1.2, 1.9}, {2.2, 2.9}, {0.4, 1.3}, {1.5, 2.5}, {2.6, 0.3}}};

/// The cloth of a spec: node (r, c) has the index r * columns + c and starts at (c spacing, ceiling height, r
/// spacing) plus the ripple, a standing wave of given amplitude in position and velocity. Pinned nodes are
/// not displaced. Deterministic. Throws std::bad_alloc.
System build_cloth(const SceneSpec& spec);

/// Lower bounds on the nodes and springs of a body of that shape, without making its mesh; zero if unknown.
/// `folder` is the scene file's. Throws SceneError if the shape is of another scene that does not exist or
/// cannot be used.
SceneCounts least_counts(const BodyShape& shape, const std::filesystem::path& folder);

}  // namespace mssim
