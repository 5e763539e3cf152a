#include <algorithm>
#include <utility>

#include "garment/layers/cloth_contacts.h"

namespace mssim {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Triangle = std::array<std::uint32_t, 3>;

/// Removes edges or triangles with a node of `sewn`.
template <class Parts>
Parts without(Parts parts, const std::set<std::uint32_t>& sewn) {
  std::erase_if(parts, [&](const auto& part) {
    return std::ranges::any_of(part, [&](std::uint32_t node) { return sewn.contains(node); });
  });
  return parts;
}

std::vector<Edge> edges_of(const GarmentPanel& panel) {
  std::vector<Edge> edges;
  for (std::uint32_t row = 0; row < panel.rows; ++row)
    for (std::uint32_t column = 0; column < panel.columns; ++column) {
      const std::uint32_t node = panel.node(row, column);
      const bool right = column + 1 < panel.columns, above = row + 1 < panel.rows;
      if (right) edges.push_back({node, node + 1});
      if (above) edges.push_back({node, node + panel.columns});
      if (right && above) edges.push_back({node, node + panel.columns + 1});
    }
  return edges;
}

std::vector<Triangle> triangles_of(const GarmentPanel& panel) {
  std::vector<Triangle> triangles;
  for (std::uint32_t row = 0; row + 1 < panel.rows; ++row)
    for (std::uint32_t column = 0; column + 1 < panel.columns; ++column)
      for (const std::uint32_t half : {0U, 1U}) triangles.push_back(panel.triangle(row, column, half));
  return triangles;
}

double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(a - d, cross(b - d, c - d));
}

/// Counts edges that run through triangles of one panel.
class PiercedPanel {
 public:
  PiercedPanel(std::vector<Triangle> triangles, std::span<const Vec3d> position)
      : position_(position), triangles_(std::move(triangles)) {
    std::ranges::sort(triangles_, {}, [&](const Triangle& triangle) { return leftmost(triangle); });
    for (const Triangle& triangle : triangles_)
      widest_ = std::max(widest_, range(triangle, &Vec3d::x)[1] - leftmost(triangle));
  }

  std::size_t crossings(const std::vector<Edge>& edges) const {
    std::size_t count = 0;
    for (const Edge& edge : edges) {
      // Only these triangles can overlap the edge in x.
      const auto [from, to] = range(edge, &Vec3d::x);
      const auto by_left = [&](const Triangle& triangle) { return leftmost(triangle); };
      const auto begin = std::ranges::lower_bound(triangles_, from - widest_, {}, by_left);
      const auto end = std::ranges::upper_bound(begin, triangles_.end(), to, {}, by_left);
      count += static_cast<std::size_t>(std::count_if(begin, end, [&](const Triangle& triangle) {
        return boxes_overlap(edge, triangle) && runs_through(edge, triangle);
      }));
    }
    return count;
  }

 private:
  /// Least and greatest coordinate of some nodes.
  template <class Nodes>
  std::array<double, 2> range(const Nodes& nodes, double Vec3d::*axis) const {
    std::array<double, 2> ends{position_[nodes[0]].*axis, position_[nodes[0]].*axis};
    for (const std::uint32_t node : nodes)
      ends = {std::min(ends[0], position_[node].*axis), std::max(ends[1], position_[node].*axis)};
    return ends;
  }
  double leftmost(const Triangle& triangle) const { return range(triangle, &Vec3d::x)[0]; }

  bool boxes_overlap(const Edge& edge, const Triangle& triangle) const {
    return std::ranges::all_of(std::array{&Vec3d::x, &Vec3d::y, &Vec3d::z}, [&](double Vec3d::*axis) {
      const auto along = range(edge, axis), across = range(triangle, axis);
      return along[0] <= across[1] && across[0] <= along[1];
    });
  }

  bool runs_through(const Edge& edge, const Triangle& triangle) const {
    const auto& [a, b, c] = triangle;
    if (above(triangle, edge[0]) == above(triangle, edge[1])) return false;
    const bool side = passes_left(edge, a, b);
    return passes_left(edge, b, c) == side && passes_left(edge, c, a) == side;
  }
  /// A node in the triangle's plane counts as above.
  bool above(const Triangle& triangle, std::uint32_t node) const {
    return volume(position_[triangle[0]], position_[triangle[1]], position_[triangle[2]], position_[node]) <=
           0;
  }
  /// Whether the edge passes on the left of the line from a to b. The result for b to a is always the
  /// opposite, even if they meet.
  bool passes_left(const Edge& edge, std::uint32_t a, std::uint32_t b) const {
    const double turn =
        volume(position_[std::min(a, b)], position_[std::max(a, b)], position_[edge[0]], position_[edge[1]]);
    return (turn > 0) == (a < b);
  }

  std::span<const Vec3d> position_;
  std::vector<Triangle> triangles_;  // by their least x
  double widest_ = 0;                // m, along x
};

}  // namespace

std::size_t count_crossings(const GarmentPanel& first, const GarmentPanel& second,
                            std::span<const Vec3d> position, const std::set<std::uint32_t>& sewn) {
  const auto through = [&](const GarmentPanel& edges, const GarmentPanel& triangles) {
    return PiercedPanel(without(triangles_of(triangles), sewn), position)
        .crossings(without(edges_of(edges), sewn));
  };
  return through(first, second) + through(second, first);
}

std::size_t count_crossings(const Garment& garment, std::span<const Vec3d> position) {
  std::size_t count = 0;
  for (const auto& [inner, outer] : layer_pairs(garment)) {
    const GarmentPanel &inside = garment.panels[inner], &outside = garment.panels[outer];
    std::set<std::uint32_t> sewn;
    for (const Joint& joint : garment.joints) {
      const std::array ends{&garment.panel_of(joint.node), &garment.panel_of(joint.edge_first)};
      if (ends == std::array{&inside, &outside} || ends == std::array{&outside, &inside})
        sewn.insert({joint.node, joint.edge_first, joint.edge_second});
    }
    count += count_crossings(inside, outside, position, sewn);
  }
  return count;
}

}  // namespace mssim
