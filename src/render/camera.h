#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "geometry/depth_raster.h"
#include "geometry/geometry.h"
#include "geometry/vec3.h"

namespace mssim {

/// From where a picture is taken, from far away and without perspective.
struct ViewDirection {
  double azimuth = 0;    ///< degrees around the vertical: 0 from +z, 90 from +x
  double elevation = 0;  ///< degrees above the horizon, -90 to 90
};

/// A row of the TABLE of views.
struct NamedView {
  std::string_view name;
  ViewDirection direction;
};
std::vector<NamedView> named_views();

/// The direction that `text` means: a name of the table or AZIMUTH,ELEVATION in degrees. None where it is
/// neither.
std::optional<ViewDirection> view_direction(std::string_view text);

/// The axes of a camera: what it sees of a point lies at (x to the right, y upwards, z towards the camera).
class Camera {
 public:
  explicit Camera(const ViewDirection& direction);

  Vec3d seen(const Vec3d& point) const { return {dot(right_, point), dot(up_, point), dot(near_, point)}; }
  const Vec3d& right() const { return right_; }
  const Vec3d& up() const { return up_; }
  /// Unit vector towards the camera.
  const Vec3d& near() const { return near_; }

 private:
  Vec3d right_, up_, near_;
};

/// The smallest grid of columns x rows square pixels around what is seen, a box of Camera::seen, that leaves
/// `margin` (a fraction of the picture) free on every side.
PixelGrid grid_around(const Box<double>& seen, std::uint32_t columns, std::uint32_t rows, double margin);

}  // namespace mssim
