#pragma once

#include <algorithm>
#include <cmath>

#include "garment/pattern/jeans.h"

namespace mssim {

/// A body to try jeans on, in formulas: an upright trunk of elliptic sections from the crotch up and two legs
/// of elliptic sections below, which part by a centimetre at the crotch.
struct JeansBody {
  double hip = 0.98;  ///< m, girth at 0.86 m; all else is in proportion

  static constexpr double crotch = 0.768;

  double scale() const { return hip / 0.98; }
  /// As of the reference body: 0.98 m at the hip, 0.88 at 0.95 m, 0.74 at the waist, and level at the hip.
  double girth(double y) const {
    if (y <= 0.86) return hip;
    const double t = (std::min(y, 1.04) - 0.86) / 0.18;
    return scale() * (0.98 - 0.24 * t * t * (1.8 - 0.8 * t));
  }
  /// Half width and half depth of the trunk, whose girth is 5.43 half widths where depth is 0.72 of width.
  double trunk_width(double y) const { return girth(y) / 5.43; }
  double trunk_depth(double y) const { return 0.72 * trunk_width(y); }
  double leg_x(double y) const {
    return (0.09 + 0.035 * (crotch - std::min(y, crotch)) / crotch) * std::max(1.0, scale());
  }
  double leg_radius(double y) const { return scale() * (0.04 + 0.045 * std::min(y, crotch) / crotch); }
  double depth(double y) const { return y >= crotch ? trunk_depth(y) : leg_radius(y); }

  bool holds(const Vec3d& p) const {
    const auto in_ellipse = [](double x, double z, double a, double b) {
      return x * x / (a * a) + z * z / (b * b) < 1;
    };
    if (p.y >= crotch) return in_ellipse(p.x, p.z, trunk_width(p.y), trunk_depth(p.y));
    const double radius = leg_radius(p.y);
    return in_ellipse(std::abs(p.x) - leg_x(p.y), p.z, radius, radius);
  }

  JeansMeasures measures() const {
    JeansMeasures measures;
    measures.girth = [body = *this](double y) { return body.girth(y); };
    return measures;
  }
  BodyDepth depths() const {
    return {[body = *this](double y) { return body.depth(y); },
            [body = *this](double y) { return -body.depth(y); }};
  }
  LegAxis leg_axis() const {
    return [body = *this](double y) { return body.leg_x(y) + 0.01; };
  }
};

}  // namespace mssim
