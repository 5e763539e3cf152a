#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// Negative inside a body, positive outside, and near its surface about the distance from it, m.
using DistanceField = std::function<double(const Vec3d& point)>;

/// Where a field is looked at: at the corners of cubes that fill the box from `low` on.
struct FieldBox {
  Vec3d low;
  double cell = 0;                       ///< m
  std::array<std::uint32_t, 3> cells{};  ///< along x, y and z
};

/// The surface on which the field is 0, closed where the field is positive on the box's sides: marching
/// tetrahedra, six to a cube.
inline Surface isosurface(const DistanceField& field, const FieldBox& box) {
  const std::array<std::uint32_t, 3> corners{box.cells[0] + 1, box.cells[1] + 1, box.cells[2] + 1};
  const auto number = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return (j * corners[2] + k) * corners[0] + i;
  };
  std::vector<Vec3d> place(std::size_t{corners[0]} * corners[1] * corners[2]);
  std::vector<double> value(place.size());
  for (std::uint32_t j = 0; j < corners[1]; ++j)
    for (std::uint32_t k = 0; k < corners[2]; ++k)
      for (std::uint32_t i = 0; i < corners[0]; ++i) {
        const std::uint32_t n = number(i, j, k);
        place[n] = box.low + box.cell * Vec3d{double(i), double(j), double(k)};
        value[n] = field(place[n]);
      }

  Surface surface;
  std::unordered_map<std::uint64_t, std::uint32_t> on_edge;
  const auto crossing = [&](std::uint32_t inner, std::uint32_t outer) {
    const std::uint64_t edge = std::uint64_t{std::min(inner, outer)} << 32 | std::max(inner, outer);
    const auto [found, is_new] = on_edge.try_emplace(edge, surface.points.size());
    if (is_new) {
      // Not too near a corner: no triangle is without area.
      const double fraction = std::clamp(value[inner] / (value[inner] - value[outer]), 0.05, 0.95);
      surface.points.push_back(place[inner] + fraction * (place[outer] - place[inner]));
    }
    return found->second;
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vec3d& outwards) {
    const Vec3d &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    if (dot(cross(q - p, r - p), outwards) > 0)
      surface.triangles.push_back({a, b, c});
    else
      surface.triangles.push_back({a, c, b});
  };
  const auto cut = [&](const std::array<std::uint32_t, 4>& tetrahedron) {
    const auto inside = std::ranges::count_if(tetrahedron, [&](auto corner) { return value[corner] < 0; });
    if (inside == 0 || inside == 4) return;
    std::vector<std::uint32_t> in, out;
    for (const std::uint32_t corner : tetrahedron) (value[corner] < 0 ? in : out).push_back(corner);
    Vec3d outwards;
    for (const std::uint32_t corner : out) outwards += 1.0 / double(out.size()) * place[corner];
    for (const std::uint32_t corner : in) outwards += -1.0 / double(in.size()) * place[corner];
    if (in.size() == 1)
      add(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]), outwards);
    else if (out.size() == 1)
      add(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]), outwards);
    else {
      const std::uint32_t a = crossing(in[0], out[0]), b = crossing(in[0], out[1]),
                          c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
      add(a, b, c, outwards);
      add(a, c, d, outwards);
    }
  };
  // Each of the six goes from a cube's lowest corner to its highest along its sides in another order.
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    for (std::uint32_t j = 0; j < box.cells[1]; ++j)
      for (std::uint32_t k = 0; k < box.cells[2]; ++k)
        for (std::uint32_t i = 0; i < box.cells[0]; ++i) {
          std::array<std::uint32_t, 3> at{i, j, k};
          std::array<std::uint32_t, 4> tetrahedron{number(i, j, k)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[order[step]];
            tetrahedron[step + 1] = number(at[0], at[1], at[2]);
          }
          cut(tetrahedron);
        }
  } while (std::next_permutation(order.begin(), order.end()));
  return surface;
}

/// Makes a closed surface coarser until it has so many triangles: edges shrink to points, which are put on
/// the field's surface, short ones first, and such as do not bend. It stays closed and connected as it was.
class Decimation {
 public:
  Decimation(Surface surface, const DistanceField& field)
      : surface_(std::move(surface)),
        field_(field),
        around_(surface_.points.size()),
        version_(surface_.points.size()),
        left_(surface_.triangles.size()) {
    for (const Vec3d& point : surface_.points) outwards_.push_back(direction(slope(point)));
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
      for (const std::uint32_t corner : surface_.triangles[t]) around_[corner].push_back(t);
    for (std::uint32_t point = 0; point < around_.size(); ++point)
      for (const std::uint32_t other : neighbours(point))
        if (point < other) offer_edge(point, other);
  }

  Surface down_to(std::size_t triangles) && {
    while (left_ > triangles && !edges_.empty()) {
      const Edge edge = edges_.top();
      edges_.pop();
      if (version_[edge.a] == edge.version_a && version_[edge.b] == edge.version_b) collapse(edge.a, edge.b);
    }
    return packed();
  }

 private:
  using Numbers = std::vector<std::uint32_t>;

  /// As it was when neither of its ends had been moved since.
  struct Edge {
    double cost = 0;
    std::uint32_t a = 0, b = 0, version_a = 0, version_b = 0;
    bool operator<(const Edge& other) const {  // the cheapest on top
      return std::tie(cost, a, b) > std::tie(other.cost, other.a, other.b);
    }
  };

  static bool has(const Numbers& numbers, std::uint32_t wanted) {
    return std::ranges::find(numbers, wanted) != numbers.end();
  }

  Numbers neighbours(std::uint32_t point) const {
    Numbers others;
    for (const std::uint32_t t : around_[point])
      for (const std::uint32_t corner : surface_.triangles[t])
        if (corner != point && !has(others, corner)) others.push_back(corner);
    return others;
  }

  void offer_edge(std::uint32_t a, std::uint32_t b) {
    constexpr double of_a_plane = 0.3;
    const double bend = length(outwards_[a] - outwards_[b]);
    const double cost = (of_a_plane + bend) * length(surface_.points[a] - surface_.points[b]);
    edges_.push({cost, a, b, version_[a], version_[b]});
  }

  /// The field's gradient.
  Vec3d slope(const Vec3d& point) const {
    constexpr double step = 1e-4;
    const double value = field_(point);
    return 1 / step *
           Vec3d{field_(point + Vec3d{step, 0, 0}) - value, field_(point + Vec3d{0, step, 0}) - value,
                 field_(point + Vec3d{0, 0, step}) - value};
  }

  static Vec3d direction(const Vec3d& vector) {
    const double size = length(vector);
    return size > 0 ? 1 / size * vector : Vec3d{};
  }

  /// Two steps of Newton's.
  Vec3d on_surface(Vec3d point) const {
    for (int turn = 0; turn < 2; ++turn) {
      const Vec3d uphill = slope(point);
      if (!(dot(uphill, uphill) > 0.04)) break;
      point += -field_(point) / dot(uphill, uphill) * uphill;
    }
    return point;
  }

  Vec3d normal(std::uint32_t triangle) const {
    const auto& [a, b, c] = surface_.triangles[triangle];
    return cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]);
  }

  /// Would a triangle that stays turn by more than about 70 degrees?
  bool turns_one(std::uint32_t point, std::uint32_t other, const Vec3d& to) {
    const Vec3d from = surface_.points[point];
    bool turned = false;
    for (const std::uint32_t t : around_[point]) {
      if (has(around_[other], t)) continue;
      const Vec3d before = normal(t);
      surface_.points[point] = to;
      const Vec3d after = normal(t);
      surface_.points[point] = from;
      turned = turned || !(dot(before, after) > 0.35 * length(before) * length(after));
    }
    return turned;
  }

  void collapse(std::uint32_t a, std::uint32_t b) {
    const Numbers beside_a = neighbours(a), beside_b = neighbours(b);
    const auto common =
        std::ranges::count_if(beside_a, [&](std::uint32_t point) { return has(beside_b, point); });
    // Otherwise the surface would touch itself.
    if (!has(beside_a, b) || common != 2 || beside_a.size() + beside_b.size() < 8) return;
    const Vec3d to = on_surface(0.5 * (surface_.points[a] + surface_.points[b]));
    if (length(to - surface_.points[a]) > length(surface_.points[b] - surface_.points[a]) ||
        turns_one(a, b, to) || turns_one(b, a, to))
      return;
    surface_.points[a] = to;
    outwards_[a] = direction(slope(to));
    for (const std::uint32_t t : Numbers(around_[b])) {
      auto& triangle = surface_.triangles[t];
      if (has(around_[a], t)) {
        for (const std::uint32_t corner : triangle) std::erase(around_[corner], t);
        triangle = {0, 0, 0};
        --left_;
      } else {
        std::ranges::replace(triangle, b, a);
        around_[a].push_back(t);
      }
    }
    around_[b].clear();
    ++version_[a];
    ++version_[b];
    for (const std::uint32_t other : neighbours(a)) offer_edge(a, other);
  }

  Surface packed() const {
    Surface surface;
    constexpr std::uint32_t unknown = UINT32_MAX;
    Numbers number(surface_.points.size(), unknown);
    for (auto triangle : surface_.triangles) {
      if (triangle[0] == triangle[1]) continue;
      for (std::uint32_t& corner : triangle) {
        if (number[corner] == unknown) {
          number[corner] = static_cast<std::uint32_t>(surface.points.size());
          surface.points.push_back(surface_.points[corner]);
        }
        corner = number[corner];
      }
      surface.triangles.push_back(triangle);
    }
    return surface;
  }

  Surface surface_;
  const DistanceField& field_;
  std::vector<Numbers> around_;  ///< the triangles of each point
  Numbers version_;
  std::vector<Vec3d> outwards_;  ///< of each point, of length 1
  std::priority_queue<Edge> edges_;
  std::size_t left_;
};

}  // namespace mssim
