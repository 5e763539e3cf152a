#pragma once

#include <vector>

#include "geometry/depth_raster.h"
#include "geometry/surface.h"

namespace mssim {

/// Depth and normal map of a body from one side, row by row.
struct SideMap {
  /// m, z of the nearest face at the pixel's centre; where there is no body -infinity from the front,
  /// +infinity from the back.
  std::vector<double> depth;
  /// Unit normal there, interpolated between those of the face's corners; (0, 0, 0) without a body.
  std::vector<Vec3d> normal;
};

/// The maps of `surface` with these normals of its points, by `threads` threads (0: as many as OpenMP takes),
/// whose number does not change a bit of them. Throws like rasterise().
SideMap side_map(const Surface& surface, const std::vector<Vec3d>& normals, const PixelGrid& grid,
                 ViewFrom view, int threads = 0);

}  // namespace mssim
