#pragma once

#include <cstdint>

#include "garment/pattern/garment_build.h"
#include "garment/pattern/jeans_outline.h"

namespace mssim {

/// How many rows and columns the panels of jeans have. Front and back have the same rows, so that their seams
/// join node to node.
struct JeansGrid {
  std::uint32_t rows = 0;
  std::uint32_t crotch_row = 0;  ///< ends in the crotch point
  std::uint32_t front_columns = 0;
  std::uint32_t back_columns = 0;

  std::uint32_t nodes() const { return 2 * rows * (front_columns + back_columns); }
};

/// Cells about square, and the number of nodes within 3 % of the wanted one. Throws InputError for less than
/// 300 or more than 10 million nodes.
JeansGrid jeans_grid(const JeansDraft& draft, std::uint32_t nodes);

/// Where the legs' axes stand: x of the wearer's left leg by height, m, positive.
using LegAxis = std::function<double(double)>;

/// Jeans of four panels ("front left", "back left", "front right", "back right", by the wearer's sides) and
/// six seams ("outer left", "outer right", "inner left", "inner right", "centre front", "centre back"), of
/// `cloth`, with about as many nodes as wanted. The wearer looks to +z, its left is +x. At the
/// outer seams, and 5 cm beside them, they are to lie close to the body, from the thigh (1 cm below the
/// crotch) up to the hip. Throws InputError as draft_jeans and jeans_grid do.
GarmentPattern jeans_pattern(const JeansMeasures& measures, std::uint32_t nodes, const PanelMaterial& cloth,
                             const LegAxis& leg_axis);

}  // namespace mssim
