#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/aligned_array.h"
#include "backends/layouts/band_layout.h"
#include "backends/layouts/spring_constants.h"
#include "model/system.h"

namespace mssim {

/// For each half of a layout's columns, how many columns of the cloth there are from one of them to the
/// cloth's end, itself included; 0 if it is none of the cloth's.
using ColumnsToEnd = std::array<std::size_t, 2>;

/// What the nodes of each row of a banded cloth compute with, one value a lane: the constants of the springs
/// that they own, and gravity. All are zero where there is no such spring, or no node: then nothing pulls,
/// dummies stay at rest, and the vector code needs no masks. Most rows share their values.
class BandRows {
 public:
  /// The constants of a column that so many are `behind`, unless it is far from the cloth's end. `springs`:
  /// by GridSpringKind. `gravity` in m/s^2.
  BandRows(const BandLayout& layout, const std::vector<SpringConstants>& springs, float gravity,
           ColumnsToEnd to_end = {far_from_end, far_from_end});

  /// Columns to the end beyond which springs reach no further.
  static constexpr std::size_t far_from_end = BandLayout::halo + 1;

  /// Vectors of a row: [spring of grid_stencil][stiffness, stiffness_rest, damping], then gravity.
  static constexpr std::size_t spring_vectors = 3;
  static constexpr std::size_t gravity_vector = grid_stencil.size() * spring_vectors;

  /// Those of row 0; the others' are offset_of_row() floats behind.
  const float* values() const { return values_.data(); }
  /// Row 0's; those of halo rows stand before and behind the rows'.
  const std::uint32_t* offset_of_row() const { return offsets_.data() + BandLayout::halo; }

 private:
  AlignedArray values_;
  std::vector<std::uint32_t> offsets_;
};

}  // namespace mssim
