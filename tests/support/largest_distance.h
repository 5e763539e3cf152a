#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

/// Of each of `a` from the same of `b`; infinite where one is not finite.
inline double largest_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d d = a[i] - b[i];
    largest = std::isfinite(dot(d, d)) ? std::max(largest, std::sqrt(dot(d, d))) : HUGE_VAL;
  }
  return largest;
}

}  // namespace mssim
