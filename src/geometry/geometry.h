#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
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

/// The smallest box that contains both.
template <class Real>
Box<Real> united(const Box<Real>& a, const Box<Real>& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

/// Extends the box to contain the point.
template <class Real>
void extend(Box<Real>& box, const Vec3<Real>& point) {
  box = united(box, {point, point});
}

/// The smallest box that contains the points; without points it is inside out.
inline Box<double> box_of(std::span<const Vec3d> points) {
  Box<double> box{{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
  for (const Vec3d& point : points) extend(box, point);
  return box;
}

/// Is the distance of two boxes along each axis less than `reach` (m)?
template <class Real>
bool near(const Box<Real>& a, const Box<Real>& b, Real reach) {
  return a.low.x - b.high.x < reach && b.low.x - a.high.x < reach && a.low.y - b.high.y < reach &&
         b.low.y - a.high.y < reach && a.low.z - b.high.z < reach && b.low.z - a.high.z < reach;
}

/// Squared distance from a point to a box, m^2; 0 inside.
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

/// The point rounded to whole micrometres, so that the last bit of libm's sines changes no mesh.
inline Vec3d rounded(const Vec3d& point) {
  constexpr double per_metre = 1e6;
  // Adding zero turns -0, whose text differs, into 0.
  const auto round_one = [](double x) { return std::round(x * per_metre) / per_metre + 0.0; };
  return {round_one(point.x), round_one(point.y), round_one(point.z)};
}

/// Largest magnitude of a coordinate in a mesh file, in the file's unit: volumes, and single-precision values
/// derived from them, then stay finite in every unit.
constexpr double farthest_coordinate = 1e9;
inline constexpr std::string_view coordinate_wanted = "give a number from -1e9 to 1e9";

/// Is it a number of at most farthest_coordinate?
inline bool is_coordinate(double x) { return std::abs(x) <= farthest_coordinate; }

/// An interval around the place where a condition ends to hold.
struct Bracket {
  double holds, fails;
};

/// Halves the interval between a number for which a condition holds and one for which it does not. Which of
/// the two is larger does not matter.
template <class Condition>
Bracket bisected(Bracket between, int halvings, const Condition& condition) {
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (between.holds + between.fails);
    (condition(middle) ? between.holds : between.fails) = middle;
  }
  return between;
}

/// A computed number for messages, without the last digits, which are rounding errors.
std::string shown(double computed);

/// "(x, y, z)" for messages.
std::string place(const Vec3d& point);

/// Disjoint sets of the numbers from 0 on (union-find); at first each number is its own set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  /// The smallest number in the set of `i`.
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

/// Twice the signed area of the triangle a, b, point: its sign is the point's side of the line from a to b.
inline double side_of(const PlanPoint& a, const PlanPoint& b, const PlanPoint& point) {
  return (b.x - a.x) * (point.z - a.z) - (b.z - a.z) * (point.x - a.x);
}

/// The perimeter of the points' convex hull, m (Andrew, "Another efficient algorithm for convex hulls in two
/// dimensions", 1979). 0 for at most one point, twice the distance for points on a line.
double hull_perimeter(std::vector<PlanPoint> points);

/// A smooth interpolating curve, monotone between neighbouring values: it never overshoots. Piecewise cubic
/// with the slopes of Fritsch and Butland ("A method for constructing local monotone piecewise cubic
/// interpolants", SIAM J. Sci. Stat. Comput. 5, 1984).
class MonotoneCurve {
 public:
  /// `positions` must ascend strictly; there must be as many `values`, at least two.
  MonotoneCurve(std::vector<double> positions, std::vector<double> values);

  /// The value at a position; beyond an end it is the end's value.
  double operator()(double position) const;

 private:
  std::vector<double> positions_, values_, slopes_;
};

}  // namespace mssim
