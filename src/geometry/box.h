#pragma once

#include <algorithm>

#include "geometry/vec3.h"

namespace mssim {

/// A box along the axes, m.
template <class Real>
struct Box {
  Vec3<Real> low, high;

  Vec3<Real> size() const { return high - low; }
  Vec3<Real> middle() const { return Real{0.5} * (low + high); }
  bool contains(const Vec3<Real>& point) const {
    return point.x >= low.x && point.x <= high.x && point.y >= low.y && point.y <= high.y &&
           point.z >= low.z && point.z <= high.z;
  }
};

/// The smallest box that holds both.
template <class Real>
Box<Real> united(const Box<Real>& a, const Box<Real>& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

/// Makes the box hold the point, too.
template <class Real>
void extend(Box<Real>& box, const Vec3<Real>& point) {
  box = united(box, {point, point});
}

/// Are two boxes, along each axis, less than `reach` (m) apart?
template <class Real>
bool near(const Box<Real>& a, const Box<Real>& b, Real reach) {
  return a.low.x - b.high.x < reach && b.low.x - a.high.x < reach && a.low.y - b.high.y < reach &&
         b.low.y - a.high.y < reach && a.low.z - b.high.z < reach && b.low.z - a.high.z < reach;
}

/// From a point to a box, m^2; 0 inside.
template <class Real>
Real distance_squared(const Box<Real>& box, const Vec3<Real>& point) {
  const auto outside = [](Real low, Real high, Real at) {
    return std::max(std::max(low - at, at - high), Real{0});
  };
  const Vec3<Real> offset{outside(box.low.x, box.high.x, point.x), outside(box.low.y, box.high.y, point.y),
                          outside(box.low.z, box.high.z, point.z)};
  return dot(offset, offset);
}

}  // namespace mssim
