#pragma once

#include <optional>
#include <string>
#include <vector>

#include "garment/fitting/dress.h"
#include "garment/fitting/fit.h"

namespace mssim {

/// What a dressed garment must keep to count as dressed.
struct FitBounds {
  double largest_gap = 1e-3;       ///< m
  double deepest = 1e-3;           ///< m that any point of the cloth may be inside the body
  double side_distance = 0.012;    ///< m
  double elongation_99 = 0.06;     ///< that 99 % of the structural and shear springs stay below
  double elongation_999 = 0.08;    ///< the same of 99.9 %
  double upper_edge_shift = 0.02;  ///< m, up or down
  double meeting_shift = 0.03;     ///< m, up or down
  double rows_astray = 0;
  double crossings = 0;  ///< of layers
};

/// One number of a fit, for a listing.
struct FitCheck {
  std::string name;  ///< ends in its unit
  double value = 0;
  std::optional<double> bound;  ///< on its magnitude; none where it has none
  std::string shown_bound;      ///< "1", or "±20" where the number may have either sign; empty without bound
  std::optional<bool> within;   ///< whether it keeps it
};

/// All numbers that the fit has, in one order.
std::vector<FitCheck> fit_checks(const Fit& fit, const FitBounds& bounds);

/// What is out of bounds, each what happened, the number and its bound, and what to try: that the garment was
/// not sewn in time, did not settle, or a number of its fit.
std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds);

}  // namespace mssim
