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

/// Most columns and rows of a picture: the rasteriser computes in whole numbers, which must not overflow.
constexpr std::uint32_t most_pixels_a_side = 8192;

/// From where a picture is taken.
enum class ViewFrom : std::uint8_t {
  front,  ///< from z = +infinity towards -z: the largest z is seen
  back    ///< from z = -infinity towards +z: the smallest z is seen
};

/// What the centre of a pixel shows.
struct Fragment {
  static constexpr std::uint32_t nothing = UINT32_MAX;

  double z = 0;                      ///< m
  std::array<float, 3> weights{};    ///< of the triangle's corners, barycentric, sum 1
  std::uint32_t triangle = nothing;  ///< index into Surface::triangles
};

/// Rows of a band, the last of a picture excepted: what one thread draws at a time.
constexpr std::uint32_t band_rows = 16;

/// What is done with a band: its first row, and its fragments row by row. Called by several threads at once,
/// each time for another band. Must not throw.
using TakeBand = std::function<void(std::uint32_t first_row, std::span<const Fragment> fragments)>;

/// Finds the nearest triangle at the centre of every pixel. Triangles count from both sides; the picture cuts
/// off what lies beside it (a corner more than 32768 pixels away from its own is drawn that far away). x and
/// y are rounded to 1/16384 of a pixel and coverage is decided in whole numbers, edges belonging to the
/// triangles on both sides: a closed surface shows no gaps, and the same pixels from the front as from the
/// back. Of triangles equally near, the first is shown. Points are finite. Works by `threads` threads (0: as
/// many as OpenMP takes); the result does not depend on their number. Throws std::invalid_argument for a grid
/// that is empty, too large, or not finite.
void rasterise(const Surface& surface, const PixelGrid& grid, ViewFrom view, int threads,
               const TakeBand& take);

/// Gives all pixels as one array, row by row.
std::vector<Fragment> rasterise(const Surface& surface, const PixelGrid& grid, ViewFrom view,
                                int threads = 0);

}  // namespace mssim
