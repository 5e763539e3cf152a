#include "render/light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "platform/machine.h"

namespace mssim {
namespace {

constexpr float key_strength = 0.6F, fill_strength = 0.22F, sky = 0.42F, ground = 0.26F;
constexpr std::uint32_t shadow_pixels = 1024;
/// Pixels of the shadow's grid that a surface may lie behind itself, so that it does not shade itself where
/// it is slanted.
constexpr double bias = 2.5;

}  // namespace

Lights::Lights(const ViewDirection& direction)
    : key_({direction.azimuth - 40, 52}), fill_({direction.azimuth + 55, 15}) {}

PointLight Lights::on(const Vec3d& normal) const {
  const auto key = static_cast<float>(dot(normal, key_.near()));
  const auto fill = static_cast<float>(dot(normal, fill_.near()));
  const float up = 0.5F * static_cast<float>(normal.y);
  const auto rest = [&](float sign) {
    return fill_strength * std::max(sign * fill, 0.0F) + sky * (0.5F + sign * up) +
           ground * (0.5F - sign * up);
  };
  return {key_strength * std::max(key, 0.0F), rest(1), key_strength * std::max(-key, 0.0F), rest(-1)};
}

std::vector<PointLight> Lights::on(const std::vector<Vec3d>& normals, int threads) const {
  std::vector<PointLight> light(normals.size());
  const int team = openmp_team(threads);
#pragma omp parallel for num_threads(team)
  for (std::size_t point = 0; point < normals.size(); ++point) light[point] = on(normals[point]);
  return light;
}

PointLight Lights::on_ground() const { return on(Vec3d{0, 1, 0}); }

Shadow::Shadow(const Surface& surface, const Camera& key, int threads) : key_(key) {
  Surface seen{{}, surface.triangles};
  seen.points.reserve(surface.points.size());
  for (const Vec3d& point : surface.points) seen.points.push_back(key.seen(point));
  Box<double> box{seen.points.front(), seen.points.front()};
  for (const Vec3d& point : seen.points) extend(box, point);
  grid_ = grid_around(box, shadow_pixels, shadow_pixels, 2.0 / shadow_pixels);
  depth_.resize(grid_.pixels());
  rasterise(seen, grid_, ViewFrom::front, threads,
            [&](std::uint32_t row, std::span<const Fragment> fragments) {
              float* out = depth_.data() + std::size_t{row} * grid_.columns;
              for (const Fragment& fragment : fragments)
                *out++ = fragment.triangle == Fragment::nothing ? -std::numeric_limits<float>::infinity()
                                                                : static_cast<float>(fragment.z);
            });
}

float Shadow::lit(std::int64_t column, std::int64_t row, double depth) const {
  if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return 1;
  return depth_[static_cast<std::size_t>(row) * grid_.columns + static_cast<std::size_t>(column)] > depth
             ? 0.0F
             : 1.0F;
}

float Shadow::smoothed(double x, double y, double depth) const {
  const auto column = static_cast<std::int64_t>(std::floor(x)),
             row = static_cast<std::int64_t>(std::floor(y));
  const auto right = static_cast<float>(x - std::floor(x)), up = static_cast<float>(y - std::floor(y));
  const float low = (1 - right) * lit(column, row, depth) + right * lit(column + 1, row, depth);
  const float high = (1 - right) * lit(column, row + 1, depth) + right * lit(column + 1, row + 1, depth);
  return (1 - up) * low + up * high;
}

float Shadow::reaching(const Vec3d& point) const {
  constexpr double reach = 0.75;  // pixels, from where the edge is smoothed
  const Vec3d seen = key_.seen(point);
  const double depth = seen.z + bias * grid_.pixel;
  const double x = (seen.x - grid_.left) / grid_.pixel - 0.5, y = (seen.y - grid_.bottom) / grid_.pixel - 0.5;
  if (!(x > -2 && y > -2 && x < shadow_pixels + 1 && y < shadow_pixels + 1)) return 1;
  return 0.25F * (smoothed(x - reach, y - reach, depth) + smoothed(x + reach, y - reach, depth) +
                  smoothed(x - reach, y + reach, depth) + smoothed(x + reach, y + reach, depth));
}

}  // namespace mssim
