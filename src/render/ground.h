#pragma once

#include <optional>

#include "geometry/geometry.h"
#include "render/camera.h"
#include "render/subject.h"

namespace mssim {

/// Level ground with a grid of lines, which fades away around what stands on it.
class Ground {
 public:
  /// Under what fills `box`, at `height` (m). Lines lie a round number of metres apart.
  Ground(const Box<double>& box, double height);

  /// Metres between the lines.
  double spacing() const { return spacing_; }

  /// Where a ray towards the camera meets the ground; none where the camera looks along it or from below.
  /// `x` and `y` are those of Camera::seen.
  std::optional<Vec3d> met_by(const Camera& camera, double x, double y) const;

  /// Its colour at a point, on `background`, where `light` of level ground's light arrives (0 to 1). Lines
  /// are smoothed over a pixel of `pixel` (m) square of the camera's.
  Light colour_at(const Vec3d& point, const Light& background, float light, const Camera& camera,
                  double pixel) const;

 private:
  double height_, spacing_, radius_;
  Vec3d middle_;
};

}  // namespace mssim
