#include "garment/contact/body_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

#include "text/text.h"

namespace mssim {

SideMap side_map(const Surface& surface, const std::vector<Vec3d>& normals, const PixelGrid& grid,
                 ViewFrom view) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Fragment> fragments = rasterise(surface, grid, view);
  SideMap map{std::vector<double>(fragments.size(), view == ViewFrom::front ? -infinity : infinity),
              std::vector<Vec3d>(fragments.size())};
  for (std::size_t pixel = 0; pixel < fragments.size(); ++pixel) {
    const Fragment& fragment = fragments[pixel];
    if (fragment.triangle == Fragment::nothing) continue;
    map.depth[pixel] = fragment.z;
    Vec3d sum;
    for (std::size_t corner = 0; corner < 3; ++corner)
      sum += double{fragment.weights[corner]} * normals[surface.triangles[fragment.triangle][corner]];
    if (const double size = length(sum); size > 0) map.normal[pixel] = (1 / size) * sum;
  }
  return map;
}

namespace {

/// Smallest z of a plane's unit normal towards the camera: 6 degrees from edge-on. The face of a limb turns
/// by about as much within a pixel at the silhouette.
constexpr double least_facing = 0.1;
/// n . P of a plane with no point behind it.
constexpr float beyond_all = -1e30F;
/// Pixels by which the maps reach beyond the silhouette.
constexpr int dilation = 2;

void check(const BodyMapSettings& settings) {
  if (!(settings.pixel > 0 && std::isfinite(settings.pixel)))
    throw std::invalid_argument(
        fmt::format("the body's maps have pixels of {} m; give a positive size", decimal(settings.pixel)));
  if (!std::isfinite(settings.offset))
    throw std::invalid_argument(fmt::format("the body's maps have an offset of {} m; give a finite length",
                                            decimal(settings.offset)));
}

/// The surface's extent with margins for offset and dilation, and a border of pixels that stay empty.
PixelGrid grid_of(const Surface& surface, const BodyMapSettings& settings) {
  check(settings);
  const auto [left, right] = std::ranges::minmax(surface.points, {}, &Vec3d::x);
  const auto [bottom, top] = std::ranges::minmax(surface.points, {}, &Vec3d::y);
  const double margin = std::abs(settings.offset) + (dilation + 1) * settings.pixel;
  const auto pixels_over = [&](double low, double high, const char* axis) {
    const double pixels = std::ceil((high - low + 2 * margin) / settings.pixel);
    if (!(pixels <= most_pixels_a_side))
      throw std::invalid_argument(fmt::format(
          "the body's maps would have {} pixels of {} m along {}; give larger pixels, so that there are at "
          "most {}",
          decimal(pixels), decimal(settings.pixel), axis, most_pixels_a_side));
    return static_cast<std::uint32_t>(pixels);
  };
  // In single precision, because later code computes the extents of pixels from this corner in it.
  return {static_cast<float>(left.x - margin), static_cast<float>(bottom.y - margin), settings.pixel,
          pixels_over(left.x, right.x, "x"), pixels_over(bottom.y, top.y, "y")};
}

Vec3d leaning_to_camera(const Vec3d& normal, double camera) {
  if (camera * normal.z >= least_facing) return normal;
  const double sideways = std::hypot(normal.x, normal.y);
  if (!(sideways > 0)) return {0, 0, camera};
  const double scale = std::sqrt(1 - least_facing * least_facing) / sideways;
  return {scale * normal.x, scale * normal.y, camera * least_facing};
}

/// The unit normal and n . P of the tangent plane of a pixel. camera: side of the image, +1 or -1.
std::array<float, 4> tangent_plane(const SideMap& map, std::size_t pixel, const Vec3d& centre,
                                   double camera) {
  const Vec3d normal = leaning_to_camera(map.normal[pixel], camera);
  const Vec3d at{centre.x, centre.y, map.depth[pixel]};
  return {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z),
          static_cast<float>(dot(normal, at))};
}

BodyPixel record(const std::array<float, 4>& front, const std::array<float, 4>& back) {
  return {{front[0], front[1], front[2], front[3], back[0], back[1], back[2], back[3]}};
}

/// Gives every empty pixel the planes of a neighbour that is not empty: preferably of one in its row, then in
/// its column, then at a corner.
void dilate(std::vector<BodyPixel>& pixels, std::uint32_t columns) {
  const auto wide = static_cast<std::ptrdiff_t>(columns);
  const std::array<std::ptrdiff_t, 8> around{-1, 1, -wide, wide, -wide - 1, -wide + 1, wide - 1, wide + 1};
  const auto is_empty = [&](std::size_t pixel) { return pixels[pixel].front_at == beyond_all; };
  std::vector<std::pair<std::size_t, std::size_t>> copies;  // to, from
  for (std::size_t pixel = columns; pixel + columns < pixels.size(); ++pixel) {
    const std::size_t column = pixel % columns;
    if (column == 0 || column + 1 == columns || !is_empty(pixel)) continue;
    for (const std::ptrdiff_t step : around)
      if (const auto from = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(pixel) + step);
          !is_empty(from)) {
        copies.emplace_back(pixel, from);
        break;
      }
  }
  for (const auto& [to, from] : copies) pixels[to] = pixels[from];
}

}  // namespace

BodyMaps::BodyMaps(const Surface& surface, const BodyMapSettings& settings) {
  validate_surface(surface, "the body");
  const PixelGrid grid = grid_of(surface, settings);
  frame_ = {static_cast<float>(grid.left), static_cast<float>(grid.bottom),
            static_cast<float>(1 / grid.pixel), static_cast<int>(grid.columns), static_cast<int>(grid.rows)};
  const Surface outwards = facing_outwards(surface);
  const std::vector<Vec3d> normals = vertex_normals(outwards);
  const Surface body = inflated(outwards, normals, settings.offset);
  const SideMap front = side_map(body, normals, grid, ViewFrom::front);
  const SideMap back = side_map(body, normals, grid, ViewFrom::back);
  constexpr std::array<float, 4> none{0, 0, 0, beyond_all};
  pixels_.assign(grid.pixels(), record(none, none));
  for (std::uint32_t row = 0; row < grid.rows; ++row)
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      const std::size_t pixel = std::size_t{row} * grid.columns + column;
      if (!std::isfinite(front.depth[pixel])) continue;
      const Vec3d centre{grid.centre_x(column), grid.centre_y(row), 0};
      pixels_[pixel] = record(tangent_plane(front, pixel, centre, 1), tangent_plane(back, pixel, centre, -1));
    }
  for (int ring = 0; ring < dilation; ++ring) dilate(pixels_, grid.columns);
}

}  // namespace mssim
