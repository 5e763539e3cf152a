#pragma once

#include <optional>

#include "geometry/geometry.h"
#include "picture/picture.h"
#include "render/camera.h"
#include "render/ground.h"
#include "render/subject.h"

namespace mssim {

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
