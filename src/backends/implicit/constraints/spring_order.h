#pragma once

#include <cstdint>

#include "backends/layouts/spring_colouring.h"
#include "model/system.h"

namespace mssim {

/// The colours of a cloth, in their order: springs along rows, then those between the rows of a pair, then
/// bending springs across rows. In that order a walk down the rows can do all colours of a row that those of
/// other rows do not wait for (row_blocks.h), and no colour needs a pass over the cloth of its own.
enum ClothColour : std::uint8_t {
  structural_from_even_columns,
  structural_from_odd_columns,
  bending_from_columns_01,  ///< from columns 0 and 1 of every four
  bending_from_columns_23,
  structural_below_even_rows,
  falling_below_even_rows,  ///< shear springs down and to the right
  rising_below_even_rows,   ///< shear springs up and to the right
  structural_below_odd_rows,
  falling_below_odd_rows,
  rising_below_odd_rows,
  bending_below_rows_01,  ///< from rows 0 and 1 of every four
  bending_below_rows_23,
  cloth_colours
};

/// The springs of a cloth or of bodies in the order in which xpbd takes them, whatever the backend: this
/// order is part of the method. A cloth has the colours of ClothColour, empty ones too; bodies have those of
/// colour_springs.
SpringColouring spring_order(const System& system);

}  // namespace mssim
