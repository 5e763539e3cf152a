#pragma once

#include <string>

#include "garment/pattern/garment_build.h"

namespace mssim {

/// A rectangular pattern piece with its lower left corner at (x, y), m.
inline PatternPiece rectangle_piece(const std::string& name, double width, double height, double x = 0,
                                    double y = 0) {
  const Vec3d lower_left{x, y, 0}, lower_right{x + width, y, 0};
  const Vec3d upper_left{x, y + height, 0}, upper_right{x + width, y + height, 0};
  return {name, Curve({lower_left, lower_right}), Curve({upper_left, upper_right}),
          Curve({lower_left, upper_left}), Curve({lower_right, upper_right})};
}

}  // namespace mssim
