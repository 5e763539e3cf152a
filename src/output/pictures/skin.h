#pragma once

#include <vector>

#include "geometry/vec3.h"
#include "model/node_surface.h"

namespace mssim {

/// The surface that a picture shows; at a crease several points are the same node.
using Skin = NodeSurface;

/// The skin of nodes that hang together like `topology` and rest at `start`. Points are divided where a
/// surface of bodies bends by more than 40 degrees there, so that edges are drawn sharp.
Skin skin_of(const Topology& topology, const std::vector<Vec3d>& start);

}  // namespace mssim
