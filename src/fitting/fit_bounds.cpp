#include "fitting/fit_bounds.h"

#include <cmath>
#include <sstream>

namespace mssim {

std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds) {
  std::vector<std::string> found;
  const auto hold = [&](const std::string& what, double value, double bound, double per_unit,
                        const std::string& unit) {
    // A number that is none keeps no bound.
    if (std::abs(value) <= bound) return;
    std::ostringstream text;
    text << what << " is " << value * per_unit << unit << ", beyond " << bound * per_unit << unit;
    found.push_back(text.str());
  };
  if (!result.seamed_at) found.emplace_back("the seams did not close");
  if (!result.settled) found.emplace_back("the garment did not come to rest");
  hold("the largest gap of a seam", fit.largest_gap, bounds.largest_gap, 1e3, " mm");
  hold("the deepest node inside the body", fit.deepest_node, bounds.deepest, 1e3, " mm");
  hold("the deepest point of a face inside the body", fit.deepest_face_sample, bounds.deepest, 1e3, " mm");
  hold("the elongation that 99 % stay below", fit.elongation_99, bounds.elongation_99, 100, " %");
  hold("the elongation that 99.9 % stay below", fit.elongation_999, bounds.elongation_999, 100, " %");
  hold("the upper edge's distance from where it is worn", fit.upper_edge_rise, bounds.upper_edge_shift, 1e3,
       " mm");
  hold("the distance of where seams meet from where that is worn", fit.meeting_rise, bounds.meeting_shift,
       1e3, " mm");
  if (fit.rows_astray > 0)
    found.push_back(std::to_string(fit.rows_astray) + " of " + std::to_string(fit.rows) +
                    " rows do not go once around their limb");
  if (fit.crossings > bounds.crossings)
    found.push_back("layers of the cloth cross each other in " + std::to_string(fit.crossings) +
                    " places, beyond " + std::to_string(bounds.crossings));
  return found;
}

}  // namespace mssim
