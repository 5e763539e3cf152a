#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

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

/// Six times the volume of the tetrahedron a, b, c, d; positive in the orientation of Tetrahedron.
constexpr double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(b - a, cross(c - a, d - a));
}

/// The point rounded to whole micrometres: what libm's last bit says about a sine then changes no mesh.
inline Vec3d rounded(const Vec3d& point) {
  constexpr double per_metre = 1e6;
  // Adding zero turns -0 into 0, which would be another text for the same place.
  const auto round_one = [](double x) { return std::round(x * per_metre) / per_metre + 0.0; };
  return {round_one(point.x), round_one(point.y), round_one(point.z)};
}

/// The farthest that a mesh file may place a node, in the file's unit: volumes, and what is computed from
/// them in single precision, stay finite then, whatever the unit.
constexpr double farthest_coordinate = 1e9;
inline constexpr std::string_view coordinate_wanted = "give a number from -1e9 to 1e9";

/// Is it a number, and not too large?
inline bool is_coordinate(double x) { return std::abs(x) <= farthest_coordinate; }

/// A number for messages that has been computed, without the last digits, which rounding has made.
std::string shown(double computed);

/// "(x, y, z)" for messages.
std::string place(const Vec3d& point);

/// The numbers from 0 on, each in a set of its own until two are united.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  /// The smallest number of the set that `i` is in.
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t of_a = root(a), of_b = root(b);
    parent_[std::max(of_a, of_b)] = std::min(of_a, of_b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A point of a horizontal plane, m.
struct PlanPoint {
  double x = 0, z = 0;

  bool operator==(const PlanPoint&) const = default;
};

/// On which side of the line from `a` to `b` a point lies: twice the area of the triangle.
inline double side_of(const PlanPoint& a, const PlanPoint& b, const PlanPoint& point) {
  return (b.x - a.x) * (point.z - a.z) - (b.z - a.z) * (point.x - a.x);
}

/// The length of a string around the points, m: the perimeter of their convex hull (Andrew, "Another
/// efficient algorithm for convex hulls in two dimensions", 1979). 0 for a single point or none, twice the
/// distance for points on a line.
double hull_perimeter(std::vector<PlanPoint> points);

/// A smooth curve through given values that is monotone between each two of them: it never overshoots.
/// Piecewise cubic with the slopes of Fritsch and Butland ("A method for constructing local monotone
/// piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5, 1984).
class MonotoneCurve {
 public:
  /// `positions` ascend strictly; there are as many `values`, two or more.
  MonotoneCurve(std::vector<double> positions, std::vector<double> values);

  /// The value at a position; beyond the ends it is that of the end.
  double operator()(double position) const;

 private:
  std::vector<double> positions_, values_, slopes_;
};

}  // namespace mssim
