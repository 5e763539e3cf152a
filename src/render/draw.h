#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "geometry/depth_raster.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"
#include "geometry/vec3.h"
#include "picture/picture.h"

namespace mssim {

/// Red, green and blue in linear light, 0 to 1.
using Light = Vec3<float>;

/// Content of a picture: triangles, not necessarily closed and seen from both sides, with a colour per point.
struct Subject {
  Surface surface;           ///< m; y points up
  std::vector<Light> front;  ///< [points] colour of the side from which a triangle is counter-clockwise
  std::vector<Light> back;   ///< [points] colour of the other side
};

/// The light of a colour in sRGB (IEC 61966-2-1).
Light light_of(const Rgb& colour);

/// The sRGB colour of light; anything brighter than white becomes white.
Rgb colour_of(const Light& light);

/// Direction from which a picture is taken, without perspective.
struct ViewDirection {
  double azimuth = 0;    ///< degrees around the vertical: 0 from +z, 90 from +x
  double elevation = 0;  ///< degrees above the horizon, -90 to 90
};

/// Parses front, side, back, three-quarter or AZIMUTH,ELEVATION in degrees; none for any other text.
std::optional<ViewDirection> view_direction(std::string_view text);

/// The axes of a camera. It sees a point at (x to the right, y upwards, z towards the camera).
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

/// The smallest grid of columns x rows square pixels around `seen`, a box of Camera::seen, with `margin` (a
/// fraction of the picture) free on every side.
PixelGrid grid_around(const Box<double>& seen, std::uint32_t columns, std::uint32_t rows, double margin);

/// Level ground with a grid of lines, which fades out around the subject.
class Ground {
 public:
  /// Ground under `box`, at `height` (m). The distance of its lines is a round number of metres.
  Ground(const Box<double>& box, double height);

  /// Where a ray towards the camera meets the ground; none if the camera looks along it or from below. `x`
  /// and `y` as in Camera::seen.
  std::optional<Vec3d> met_by(const Camera& camera, double x, double y) const;

  /// Its colour at a point, on `background`; `light` is the fraction of level ground's light that arrives.
  /// Lines are smoothed over a square pixel of the camera with sides of `pixel` (m).
  Light colour_at(const Vec3d& point, const Light& background, float light, const Camera& camera,
                  double pixel) const;

 private:
  double height_, spacing_, radius_;
  Vec3d middle_;
};

/// Most pixels of a picture, across and down: each is drawn at four by four points.
inline constexpr std::uint32_t most_picture_pixels = most_pixels_a_side / 4;

/// Camera, size and content of a picture.
struct Shot {
  ViewDirection direction;
  std::uint32_t width = 960, height = 720;  ///< pixels, up to most_picture_pixels
  Box<double> seen{};                       ///< what the picture must show, a box of Camera::seen
  std::optional<Ground> ground;
  int threads = 1;
};

/// Unit vector towards the light that casts shadows in pictures from `direction`; it points upwards.
Vec3d shadow_light(const ViewDirection& direction);

/// The box around points in coordinates of Camera::seen.
Box<double> seen_box(const Camera& camera, const std::vector<Vec3d>& points);

/// The samples of a picture as pixels of a grid: four by four per pixel. The content has a margin of 6 % on
/// each side.
PixelGrid drawn_points(const Shot& shot);

/// Draws a subject, which must have points. Two lights and the sky shade it; the first casts its shadow on
/// the subject and the ground; each pixel is the mean of sixteen samples. The number of threads does not
/// change the picture.
Picture drawn(const Subject& subject, const Shot& shot);

}  // namespace mssim
