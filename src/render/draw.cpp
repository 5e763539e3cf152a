#include "render/draw.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/surface.h"
#include "render/light.h"
#include "render/srgb.h"

namespace mssim {
namespace {

/// Points of a pixel in each direction.
constexpr std::uint32_t samples = 4;
static_assert(band_rows % samples == 0, "a band is whole rows of pixels");

constexpr Light backdrop{0.91F, 0.92F, 0.94F};

/// Everything that the light of a sample depends on.
struct Stage {
  const Subject& subject;
  const Shot& shot;
  const Camera& camera;
  const PixelGrid& grid;  ///< of samples
  const std::vector<PointLight>& light;
  const Shadow& shadow;
  const Surface& seen;  ///< the subject as the camera sees it
  PointLight ground_light;

  Light of_ground(const Vec3d& point) const {
    const float key = ground_light.key_front, rest = ground_light.rest_front;
    const float light_there = (rest + key * shadow.reaching(point)) / (rest + key);
    return shot.ground->colour_at(point, backdrop, light_there, camera, samples * grid.pixel);
  }

  Light of_triangle(const Fragment& fragment, const Vec3d& point) const {
    const auto& corners = seen.triangles[fragment.triangle];
    const Vec3d &a = seen.points[corners[0]], &b = seen.points[corners[1]], &c = seen.points[corners[2]];
    const bool front = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
    float key = 0, rest = 0;
    Light colour;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const PointLight& at = light[corners[i]];
      const float weight = fragment.weights[i];
      key += weight * (front ? at.key_front : at.key_back);
      rest += weight * (front ? at.rest_front : at.rest_back);
      colour += weight * (front ? subject.front : subject.back)[corners[i]];
    }
    if (key > 0) key *= shadow.reaching(point);
    return (key + rest) * colour;
  }

  Light of(const Fragment& fragment, double x, double y) const {
    const bool hit = fragment.triangle != Fragment::nothing;
    if (shot.ground)
      if (const std::optional<Vec3d> point = shot.ground->met_by(camera, x, y))
        if (!hit || dot(camera.near(), *point) > fragment.z) return of_ground(*point);
    if (!hit) return backdrop;
    return of_triangle(fragment, x * camera.right() + y * camera.up() + fragment.z * camera.near());
  }
};

/// The sixteen fragments of a pixel.
struct PixelFragments {
  const Fragment* first;  ///< of the lowest row
  std::size_t row_pitch;  ///< from a row of fragments to the next
  double x, y;            ///< m, the centre of the first
  const Fragment& at(std::uint32_t i, std::uint32_t j) const { return first[j * row_pitch + i]; }
};

/// The pixel's light, the mean of its points. A pixel of nothing but ground, or of one smooth surface, is
/// shaded at fewer points than it is drawn at.
Light mean_light(const Stage& stage, const PixelFragments& pixel) {
  std::uint32_t hits = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::uint32_t j = 0; j < samples; ++j)
    for (std::uint32_t i = 0; i < samples; ++i)
      if (const Fragment& fragment = pixel.at(i, j); fragment.triangle != Fragment::nothing) {
        ++hits;
        low = std::min(low, fragment.z);
        high = std::max(high, fragment.z);
      }
  const double step = stage.grid.pixel;
  const auto light_at = [&](std::uint32_t i, std::uint32_t j) {
    return stage.of(pixel.at(i, j), pixel.x + i * step, pixel.y + j * step);
  };
  if (hits == 0) return stage.of(*pixel.first, pixel.x + 1.5 * step, pixel.y + 1.5 * step);
  if (hits == samples * samples && high - low < 2 * samples * step)
    return 0.25F * (light_at(1, 0) + light_at(3, 1) + light_at(0, 2) + light_at(2, 3));
  Light sum;
  for (std::uint32_t j = 0; j < samples; ++j)
    for (std::uint32_t i = 0; i < samples; ++i) sum += light_at(i, j);
  return (1.0F / (samples * samples)) * sum;
}

}  // namespace

Box<double> seen_box(const Camera& camera, const std::vector<Vec3d>& points) {
  const Vec3d first = camera.seen(points.front());
  Box<double> box{first, first};
  for (const Vec3d& point : points) extend(box, camera.seen(point));
  return box;
}

PixelGrid drawn_points(const Shot& shot) {
  constexpr double margin = 0.06;
  return grid_around(shot.seen, samples * shot.width, samples * shot.height, margin);
}

Picture drawn(const Subject& subject, const Shot& shot) {
  const Camera camera(shot.direction);
  const Lights lights(shot.direction);
  const std::vector<PointLight> light = lights.on(vertex_normals(subject.surface), shot.threads);
  const Shadow shadow(subject.surface, lights.key(), shot.threads);
  Surface seen{{}, subject.surface.triangles};
  seen.points.reserve(subject.surface.points.size());
  for (const Vec3d& point : subject.surface.points) seen.points.push_back(camera.seen(point));
  const PixelGrid grid = drawn_points(shot);
  const Stage stage{subject, shot, camera, grid, light, shadow, seen, lights.on_ground()};
  Picture picture(shot.width, shot.height);
  rasterise(seen, grid, ViewFrom::front, shot.threads,
            [&](std::uint32_t first_row, std::span<const Fragment> fragments) {
              const auto rows = static_cast<std::uint32_t>(fragments.size() / grid.columns);
              for (std::uint32_t row = 0; row < rows; row += samples)
                for (std::uint32_t x = 0; x < shot.width; ++x) {
                  const PixelFragments pixel{&fragments[std::size_t{row} * grid.columns + samples * x],
                                             grid.columns, grid.centre_x(samples * x),
                                             grid.centre_y(first_row + row)};
                  picture.at(x, shot.height - 1 - (first_row + row) / samples) =
                      colour_of(mean_light(stage, pixel));
                }
            });
  return picture;
}

}  // namespace mssim
