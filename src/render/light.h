#pragma once

#include <vector>

#include "geometry/depth_raster.h"
#include "render/camera.h"
#include "render/subject.h"

namespace mssim {

/// How two lights and the sky fall on the points of a subject, for each of its sides.
struct PointLight {
  float key_front = 0, rest_front = 0;  ///< from the key light, which casts shadows; from all others
  float key_back = 0, rest_back = 0;
};

/// The lights of a picture taken from `direction`: the key light stands high to the left of the camera, the
/// fill light low to its right, and the sky is brighter than the ground.
class Lights {
 public:
  explicit Lights(const ViewDirection& direction);

  const Camera& key() const { return key_; }
  /// [points] by the normals of the subject's points (vertex_normals).
  std::vector<PointLight> on(const std::vector<Vec3d>& normals, int threads) const;
  /// What falls on level ground, in the light of the key.
  PointLight on_ground() const;

 private:
  PointLight on(const Vec3d& normal) const;

  Camera key_, fill_;
};

/// What the key light reaches: the nearest surface to it, on a grid of its own.
class Shadow {
 public:
  /// Maps the shadow of the subject's triangles. `threads` as in rasterise().
  Shadow(const Surface& surface, const Camera& key, int threads);

  /// How much of the key light reaches a point: 0 in the shadow to 1, between them at its edge.
  float reaching(const Vec3d& point) const;

 private:
  float lit(std::int64_t column, std::int64_t row, double depth) const;
  /// Between the four pixels around (x, y).
  float smoothed(double x, double y, double depth) const;

  const Camera& key_;
  PixelGrid grid_;
  std::vector<float>
      depth_;  ///< [rows][columns] of the grid, m towards the light; -infinity where nothing is
};

}  // namespace mssim
