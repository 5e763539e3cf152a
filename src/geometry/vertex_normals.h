#pragma once

#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// Unit normals of the surface's points, pointing out of the body: the sum of the normals of the triangles
/// around a point, each weighted with the triangle's angle there (Thürmer and Wüthrich, "Computing vertex
/// normals from polygonal facets", 1998). They do not depend on how flat polygons are cut into triangles.
/// Where the sum vanishes the normal is (0, 0, 0).
std::vector<Vec3d> vertex_normals(const Surface& surface);

/// The surface with every point moved by `offset` (m, inwards where negative) along its normal.
Surface inflated(const Surface& surface, const std::vector<Vec3d>& normals, double offset);

}  // namespace mssim
