#pragma once

#include <optional>
#include <vector>

#include "geometry/geometry.h"
#include "geometry/surface.h"

namespace mssim {

/// What is between the two legs of an upright body at a height: no point of its section.
struct LegGap {
  double height = 0;         ///< y
  double low = 0, high = 0;  ///< x
  PlanPoint right, left;  ///< the middles of the boxes around what lies on either side, at lower and higher x
};

/// The gap between the legs at this height, none where the section does not fall apart into two halves that
/// are about equally wide. The surface, which stands upright in y, need not be closed; lengths are in its
/// unit.
std::optional<LegGap> leg_gap(const Surface& body, double height);

/// The gaps at evenly spaced heights, from below upwards, of the longest run of heights that have one.
std::vector<LegGap> leg_gaps(const Surface& body);

/// The x that is between the legs at the highest gap, and at as many of those below as there is one.
double between_legs(const std::vector<LegGap>& gaps);

}  // namespace mssim
