#pragma once

#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// The connected parts of a closed surface: triangles that share a point belong to one. Each part keeps the
/// order of its triangles and points, and parts stand in the order of their first triangles. A part that
/// points inwards (its volume is negative) is turned round, so that outside is the same for all.
std::vector<Surface> closed_parts(const Surface& surface);

/// The parts as one surface again, all of them facing outwards.
Surface facing_outwards(const Surface& surface);

}  // namespace mssim
