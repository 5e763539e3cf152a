#pragma once

#include <array>
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

/// What a picture shows at one moment: triangles that need not close, seen from both sides, each point with
/// the colour of what it belongs to.
struct Subject {
  Surface surface;           ///< m; y points up
  std::vector<Light> front;  ///< [points] colour of the side that a triangle is counter-clockwise from
  std::vector<Light> back;   ///< [points] of the other side
};

/// The light of a colour in sRGB (IEC 61966-2-1).
Light light_of(const Rgb& colour);

/// The colour of light in sRGB, what is brighter than white as white.
Rgb colour_of(const Light& light);

/// From where a picture is taken, from far away and without perspective.
struct ViewDirection {
  double azimuth = 0;    ///< degrees around the vertical: 0 from +z, 90 from +x
  double elevation = 0;  ///< degrees above the horizon, -90 to 90
};

/// The direction that `text` means: front, side, back, three-quarter or AZIMUTH,ELEVATION in degrees. None
/// where it is neither.
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

/// Most pixels of a picture, across and down: each is drawn at four by four points.
inline constexpr std::uint32_t most_picture_pixels = most_pixels_a_side / 4;

/// How a picture is taken.
struct Shot {
  ViewDirection direction;
  std::uint32_t width = 960, height = 720;  ///< pixels, up to most_picture_pixels
  Box<double> seen{};                       ///< what the picture must show, a box of Camera::seen
  std::optional<Ground> ground;
  int threads = 1;
};

/// Unit vector towards the light that casts shadows in pictures from `direction`; it points upwards.
Vec3d shadow_light(const ViewDirection& direction);

/// The box of Camera::seen around points.
Box<double> seen_box(const Camera& camera, const std::vector<Vec3d>& points);

/// The points that a picture is drawn at, as the pixels of a grid: four by four in each of its own pixels.
/// What it must show lies inside a margin of 6 % on each side.
PixelGrid drawn_points(const Shot& shot);

/// Draws a subject, which has points: shaded by two lights and the sky, with the shadow of the first on
/// itself and on the ground, each pixel the mean of sixteen points. The same picture whatever the number of
/// threads.
Picture drawn(const Subject& subject, const Shot& shot);

}  // namespace mssim
