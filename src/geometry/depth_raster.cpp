#include "geometry/depth_raster.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Fixed-point coordinates stay below 2^29, so that the difference of two products of differences stays below
/// 2^61.
constexpr std::int64_t subpixels = 16384;
constexpr double farthest = 4.0 * most_pixels_a_side;

struct FixedPoint {
  std::int64_t x = 0, y = 0;
};

/// Range of pixels whose centres may lie in a triangle.
struct PixelRange {
  std::int64_t first_column = 0, end_column = 0;
  std::int64_t first_row = 0, end_row = 0;
};

/// Twice the area of the triangle, positive if its corners are counter-clockwise.
std::int64_t area(const FixedPoint& a, const FixedPoint& b, const FixedPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The pixels from `low` to `high` whose centres, at half pixels, lie between them.
std::int64_t first_centre(std::int64_t low) { return (low + subpixels / 2 - 1) / subpixels; }
std::int64_t end_centre(std::int64_t high) { return (high + subpixels / 2) / subpixels; }

void check(const PixelGrid& grid) {
  if (!(grid.pixel > 0 && std::isfinite(grid.pixel)))
    throw std::invalid_argument(
        fmt::format("a picture has pixels of {} m; give a positive size", decimal(grid.pixel)));
  if (!std::isfinite(grid.left) || !std::isfinite(grid.bottom))
    throw std::invalid_argument(fmt::format("a picture begins at x = {} m, y = {} m; give finite numbers",
                                            decimal(grid.left), decimal(grid.bottom)));
  if (grid.columns == 0 || grid.rows == 0 || grid.columns > most_pixels_a_side ||
      grid.rows > most_pixels_a_side)
    throw std::invalid_argument(fmt::format("a picture has {} x {} pixels; give 1 to {} each way",
                                            grid.columns, grid.rows, most_pixels_a_side));
}

class Raster {
 public:
  Raster(const Surface& surface, const PixelGrid& grid, ViewFrom view)
      : surface_(surface), grid_(grid), sign_(view == ViewFrom::front ? 1 : -1) {
    points_.reserve(surface.points.size());
    for (const Vec3d& point : surface.points)
      points_.push_back({fixed(point.x - grid.left), fixed(point.y - grid.bottom)});
    bands_.resize((grid.rows + band_rows - 1) / band_rows);
    ranges_.reserve(surface.triangles.size());
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const PixelRange& range = ranges_.emplace_back(range_of(surface.triangles[t]));
      if (range.first_column >= range.end_column || range.first_row >= range.end_row) continue;
      for (std::int64_t band = range.first_row / band_rows; band <= (range.end_row - 1) / band_rows; ++band)
        bands_[static_cast<std::size_t>(band)].push_back(t);
    }
  }

  void draw(int threads, const TakeBand& take) const {
    const int team = openmp_team(threads);
    // One band per thread, allocated here, where it may throw.
    std::vector<std::vector<Fragment>> drawn(static_cast<std::size_t>(team),
                                             std::vector<Fragment>(std::size_t{band_rows} * grid_.columns));
#pragma omp parallel for num_threads(team) schedule(dynamic)
    for (std::size_t band = 0; band < bands_.size(); ++band)
      draw_band(band, drawn[static_cast<std::size_t>(omp_get_thread_num())], take);
  }

 private:
  std::int64_t fixed(double metres) const {
    const double pixels = std::clamp(metres / grid_.pixel, -farthest, farthest);
    return static_cast<std::int64_t>(std::lround(pixels * static_cast<double>(subpixels)));
  }

  PixelRange range_of(const std::array<std::uint32_t, 3>& triangle) const {
    const FixedPoint &a = points_[triangle[0]], &b = points_[triangle[1]], &c = points_[triangle[2]];
    return {std::max<std::int64_t>(first_centre(std::min({a.x, b.x, c.x})), 0),
            std::min<std::int64_t>(end_centre(std::max({a.x, b.x, c.x})), grid_.columns),
            std::max<std::int64_t>(first_centre(std::min({a.y, b.y, c.y})), 0),
            std::min<std::int64_t>(end_centre(std::max({a.y, b.y, c.y})), grid_.rows)};
  }

  void draw_band(std::size_t band, std::span<Fragment> drawn, const TakeBand& take) const {
    const std::int64_t first_row = static_cast<std::int64_t>(band) * band_rows;
    const std::int64_t end_row = std::min<std::int64_t>(first_row + band_rows, grid_.rows);
    const std::span<Fragment> fragments =
        drawn.first(static_cast<std::size_t>(end_row - first_row) * grid_.columns);
    std::ranges::fill(fragments, Fragment{});
    for (const std::uint32_t t : bands_[band]) {
      PixelRange range = ranges_[t];
      range.first_row = std::max(range.first_row, first_row);
      range.end_row = std::min(range.end_row, end_row);
      draw_triangle(t, range, first_row, fragments);
    }
    take(static_cast<std::uint32_t>(first_row), fragments);
  }

  /// Draws the part of a triangle within `range` into the band that begins at `first_row`.
  void draw_triangle(std::uint32_t number, const PixelRange& range, std::int64_t first_row,
                     std::span<Fragment> fragments) const {
    const auto& [ia, ib, ic] = surface_.triangles[number];
    const FixedPoint &a = points_[ia], &b = points_[ib], &c = points_[ic];
    const std::int64_t whole = area(a, b, c);
    if (whole == 0) return;  // edge-on: its neighbours cover these pixels
    const std::int64_t turn = whole > 0 ? 1 : -1;
    const double per_area = 1 / static_cast<double>(turn * whole);
    const double za = surface_.points[ia].z, zb = surface_.points[ib].z, zc = surface_.points[ic].z;
    // Increment of the area opposite to each corner from one pixel to the next in its row:
    const std::int64_t step_a = turn * (b.y - c.y) * subpixels, step_b = turn * (c.y - a.y) * subpixels,
                       step_c = turn * (a.y - b.y) * subpixels;
    for (std::int64_t row = range.first_row; row < range.end_row; ++row) {
      const FixedPoint centre{range.first_column * subpixels + subpixels / 2,
                              row * subpixels + subpixels / 2};
      std::int64_t at_a = turn * area(b, c, centre), at_b = turn * area(c, a, centre),
                   at_c = turn * area(a, b, centre);
      Fragment* shown = fragments.data() + static_cast<std::size_t>(row - first_row) * grid_.columns +
                        static_cast<std::size_t>(range.first_column);
      for (std::int64_t column = range.first_column; column < range.end_column;
           ++column, ++shown, at_a += step_a, at_b += step_b, at_c += step_c) {
        if ((at_a | at_b | at_c) < 0) continue;  // outside: one of them is negative
        const double wa = static_cast<double>(at_a) * per_area, wb = static_cast<double>(at_b) * per_area,
                     wc = static_cast<double>(at_c) * per_area;
        const double z = wa * za + wb * zb + wc * zc;
        if (shown->triangle == Fragment::nothing || sign_ * z > sign_ * shown->z)
          *shown = {z, {static_cast<float>(wa), static_cast<float>(wb), static_cast<float>(wc)}, number};
      }
    }
  }

  const Surface& surface_;
  const PixelGrid& grid_;
  double sign_;
  std::vector<FixedPoint> points_;
  std::vector<PixelRange> ranges_;                 // [triangles]
  std::vector<std::vector<std::uint32_t>> bands_;  // [bands] the triangles that reach into each, in order
};

}  // namespace

void rasterise(const Surface& surface, const PixelGrid& grid, ViewFrom view, int threads,
               const TakeBand& take) {
  check(grid);
  Raster(surface, grid, view).draw(threads, take);
}

std::vector<Fragment> rasterise(const Surface& surface, const PixelGrid& grid, ViewFrom view, int threads) {
  std::vector<Fragment> all;
  check(grid);
  all.resize(grid.pixels());
  rasterise(surface, grid, view, threads, [&](std::uint32_t first_row, std::span<const Fragment> fragments) {
    std::ranges::copy(fragments, all.begin() + static_cast<std::ptrdiff_t>(first_row) * grid.columns);
  });
  return all;
}

}  // namespace mssim
