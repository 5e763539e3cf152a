#include "geometry/triangle_tree.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace mssim {

namespace {

constexpr std::uint32_t leaf_triangles = 4;
/// Halving puts a leaf of a tree of 2^32 triangles about 30 levels deep.
constexpr std::size_t deepest = 64;

double squared(const Vec3d& a) { return dot(a, a); }

double squared_distance_from_side(const Vec3d& a, const Vec3d& b, const Vec3d& point) {
  const Vec3d side = b - a;
  const double along = std::clamp(dot(point - a, side) / squared(side), 0.0, 1.0);
  return squared(point - (a + along * side));
}

/// Squared distance to the plane if the perpendicular's foot is in the triangle, else to the nearest side.
double squared_distance(const std::array<Vec3d, 3>& triangle, const Vec3d& point) {
  const auto& [a, b, c] = triangle;
  const Vec3d normal = cross(b - a, c - a);
  const auto beside = [&](const Vec3d& from, const Vec3d& to) {
    return dot(cross(to - from, point - from), normal);
  };
  if (beside(a, b) >= 0 && beside(b, c) >= 0 && beside(c, a) >= 0) {
    const double height = dot(point - a, normal);
    return height * height / squared(normal);
  }
  return std::min({squared_distance_from_side(a, b, point), squared_distance_from_side(b, c, point),
                   squared_distance_from_side(c, a, point)});
}

/// A sum of products with a bound on its rounding error: beyond the bound its sign is certain.
struct Determinant {
  double value = 0, error = 0;

  bool positive() const { return value > error; }
  bool negative() const { return value < -error; }
};

/// Twice the area of the triangle o, a, b seen against x, with the origin o. Each product has three roundings
/// (its factors are rounded differences), and their difference has one more: 4 units of half an epsilon.
Determinant area_of(const Vec3d& a, const Vec3d& b) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  const double plus = a.y * b.z, minus = a.z * b.y;
  return {plus - minus, rounding * (std::abs(plus) + std::abs(minus))};
}

/// Contribution of the triangle (relative to the ray's start) to the winding number.
std::optional<int> crossing(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  if (std::max({a.x, b.x, c.x}) < 0) return 0;
  const std::array<Determinant, 3> sides{area_of(b, c), area_of(c, a), area_of(a, b)};
  bool one_positive = false, one_negative = false, all_certain = true;
  for (const Determinant& side : sides) {
    one_positive = one_positive || side.positive();
    one_negative = one_negative || side.negative();
    all_certain = all_certain && (side.positive() || side.negative());
  }
  if (one_positive && one_negative) return 0;  // the line misses it
  if (!all_certain) return std::nullopt;
  const int facing = one_positive ? 1 : -1;
  if (std::min({a.x, b.x, c.x}) > 0) return facing;
  // Six times the volume under the triangle: intersection of plane and line, times twice the area.
  Determinant volume;
  const std::array<double, 3> heights{a.x, b.x, c.x};
  for (std::size_t k = 0; k < 3; ++k) {
    volume.value += sides[k].value * heights[k];
    volume.error += (sides[k].error + 8 * std::numeric_limits<double>::epsilon() * std::abs(sides[k].value)) *
                    std::abs(heights[k]);
  }
  if (volume.positive()) return one_positive ? facing : 0;
  if (volume.negative()) return one_positive ? 0 : facing;
  return std::nullopt;
}

}  // namespace

TriangleTree::TriangleTree(const Surface& surface) {
  triangles_.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles)
    triangles_.push_back({surface.points[a], surface.points[b], surface.points[c]});
  nodes_.reserve(triangles_.size());
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleTree::build(std::uint32_t first, std::uint32_t end) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  const auto centre = [](const Triangle& t) { return t[0] + t[1] + t[2]; };  // times three
  Box<double> box{triangles_[first][0], triangles_[first][0]};
  Box<double> centres{centre(triangles_[first]), centre(triangles_[first])};
  for (std::uint32_t t = first; t < end; ++t) {
    for (const Vec3d& corner : triangles_[t]) extend(box, corner);
    extend(centres, centre(triangles_[t]));
  }
  nodes_[self].box = box;
  if (end - first <= leaf_triangles) {
    nodes_[self].first = first;
    nodes_[self].count = end - first;
    return;
  }
  const Vec3d size = centres.size();
  double Vec3d::*const axis = size.x >= size.y && size.x >= size.z ? &Vec3d::x
                              : size.y >= size.z                   ? &Vec3d::y
                                                                   : &Vec3d::z;
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const Triangle& a, const Triangle& b) { return centre(a).*axis < centre(b).*axis; });
  build(first, middle);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

double TriangleTree::distance(const Vec3d& point, double limit) const {
  struct Visit {
    std::uint32_t node;
    double least;
  };
  std::array<Visit, deepest> stack;
  std::size_t waiting = 0;
  double best = limit * limit;
  stack[waiting++] = {0, distance_squared(nodes_[0].box, point)};
  while (waiting > 0) {
    const Visit visit = stack[--waiting];
    if (visit.least >= best) continue;
    const Node& node = nodes_[visit.node];
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
      best = std::min(best, squared_distance(triangles_[t], point));
    if (node.count > 0) continue;
    Visit near{visit.node + 1, distance_squared(nodes_[visit.node + 1].box, point)};
    Visit far{node.first, distance_squared(nodes_[node.first].box, point)};
    if (far.least < near.least) std::swap(near, far);
    stack[waiting++] = far;
    stack[waiting++] = near;
  }
  return best < limit * limit ? std::sqrt(best) : limit;
}

std::optional<int> TriangleTree::winding_by_ray(const Vec3d& point) const {
  std::array<std::uint32_t, deepest> stack;
  std::size_t waiting = 0;
  int winding = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const std::uint32_t number = stack[--waiting];
    const auto& [box, first, count] = nodes_[number];
    if (box.high.x < point.x || box.low.y > point.y || box.high.y < point.y || box.low.z > point.z ||
        box.high.z < point.z)
      continue;
    for (std::uint32_t t = first; t < first + count; ++t) {
      const auto& [a, b, c] = triangles_[t];
      const std::optional<int> part = crossing(a - point, b - point, c - point);
      if (!part) return std::nullopt;
      winding += *part;
    }
    if (count > 0) continue;
    stack[waiting++] = first;
    stack[waiting++] = number + 1;
  }
  return winding;
}

int TriangleTree::winding_by_angles(const Vec3d& point) const {
  double half_angles = 0;
  for (const auto& corners : triangles_) {
    const Vec3d a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double la = length(a), lb = length(b), lc = length(c);
    half_angles +=
        std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return static_cast<int>(std::lround(half_angles / (2 * std::numbers::pi)));
}

}  // namespace mssim
