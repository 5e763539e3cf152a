#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// The pixels of an orthographic picture along z: x to the right, y upwards, row 0 the lowest.
struct PixelGrid {
  double left = 0, bottom = 0;  ///< m, the lower left corner of pixel (0, 0)
  double pixel = 0;             ///< m, width and height of a pixel
  std::uint32_t columns = 0, rows = 0;

  std::size_t pixels() const { return std::size_t{columns} * rows; }
  double centre_x(std::uint32_t column) const { return left + (column + 0.5) * pixel; }
  double centre_y(std::uint32_t row) const { return bottom + (row + 0.5) * pixel; }
};

/// Maximum columns and rows of a picture: the rasteriser's integers must not overflow.
constexpr std::uint32_t most_pixels_a_side = 8192;

/// The direction of view.
enum class ViewFrom : std::uint8_t {
  front,  ///< from z = +infinity towards -z: the largest z is visible
  back    ///< from z = -infinity towards +z: the smallest z is visible
};

/// The nearest surface point at the centre of a pixel.
struct Fragment {
  static constexpr std::uint32_t nothing = UINT32_MAX;

  double z = 0;                      ///< m
  std::array<float, 3> weights{};    ///< of the triangle's corners, barycentric, sum 1
  std::uint32_t triangle = nothing;  ///< index into Surface::triangles
};

/// Rows of a band, which one thread draws at a time; a picture's last band may have fewer.
constexpr std::uint32_t band_rows = 16;

/// Receives a band: its first row, and its fragments row by row. Several threads call it concurrently, each
/// for another band. Must not throw.
using TakeBand = std::function<void(std::uint32_t first_row, std::span<const Fragment> fragments)>;

/// Finds the nearest triangle at the centre of every pixel. Both sides of triangles are visible. Triangles
/// are clipped to the picture, except that corners more than 32768 pixels outside are moved to that distance.
/// x and y are rounded to 1/16384 of a pixel and coverage is decided in integers, with edges belonging to the
/// triangles on both sides: a closed surface shows no gaps, and covers the same pixels from the front as from
/// the back. Of equally near triangles, the first is shown. Points must be finite. Uses `threads` threads (0:
/// OpenMP's default); the result does not depend on their number. Throws std::invalid_argument for a grid
/// that is empty, too large, or not finite.
void rasterise(const Surface& surface, const PixelGrid& grid, ViewFrom view, int threads,
               const TakeBand& take);

/// The fragments of all pixels as one array, row by row.
std::vector<Fragment> rasterise(const Surface& surface, const PixelGrid& grid, ViewFrom view,
                                int threads = 0);

}  // namespace mssim
