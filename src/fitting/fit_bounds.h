#pragma once

#include <string>
#include <vector>

#include "fitting/dress.h"
#include "fitting/fit.h"

namespace mssim {

/// What a dressed garment must keep to count as dressed.
struct FitBounds {
  double largest_gap = 1e-3;       ///< m
  double deepest = 1e-3;           ///< m that any point of the cloth may be inside the body
  double elongation_99 = 0.06;     ///< that 99 % of the structural and shear springs stay below
  double elongation_999 = 0.08;    ///< the same of 99.9 %
  double upper_edge_shift = 0.02;  ///< m, up or down
  double meeting_shift = 0.03;     ///< m, up or down
  std::size_t crossings = 0;       ///< of layers
};

/// What is out of bounds, a sentence each: that the garment was not sewn in time, did not settle, or a number
/// of its fit and the bound.
std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds);

}  // namespace mssim
