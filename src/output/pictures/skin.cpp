#include "output/pictures/skin.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/geometry.h"

namespace mssim {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Vec3d normal_of(const Triangle& triangle, const std::vector<Vec3d>& points) {
  const Vec3d& a = points[triangle[0]];
  const Vec3d normal = cross(points[triangle[1]] - a, points[triangle[2]] - a);
  const double size = length(normal);
  return size > 0 ? (1 / size) * normal : Vec3d{};
}

/// Which corners of triangles share a point: [3 triangle + corner], a number of the set of each. Corners at a
/// node share one where a way leads from one to the other over edges that bend little.
DisjointSets smooth_corners(const std::vector<Triangle>& triangles, const std::vector<Vec3d>& start) {
  const double least_cosine = std::cos(40 * std::numbers::pi / 180);
  DisjointSets corners(3 * triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_at;  // by edge: its first triangle
  const auto corner_at = [&](std::uint32_t triangle, std::uint32_t node) {
    const auto& nodes = triangles[triangle];
    return 3 * triangle + static_cast<std::uint32_t>(std::ranges::find(nodes, node) - nodes.begin());
  };
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
      const auto [found, is_first] = first_at.try_emplace({low, high}, t);
      const std::uint32_t other = found->second;
      if (is_first || dot(normal_of(triangles[t], start), normal_of(triangles[other], start)) < least_cosine)
        continue;
      for (const std::uint32_t node : {low, high}) corners.unite(corner_at(t, node), corner_at(other, node));
    }
  return corners;
}

/// A point for each smooth side of a node.
void divide_at_creases(Skin& skin, const std::vector<Vec3d>& start) {
  std::vector<Vec3d> position;
  position.reserve(skin.node.size());
  for (const std::uint32_t node : skin.node) position.push_back(start[node]);
  DisjointSets corners = smooth_corners(skin.triangles, position);
  std::vector<std::uint32_t> node, part, point(3 * skin.triangles.size());
  for (std::uint32_t corner = 0; corner < point.size(); ++corner) {
    std::uint32_t& shown = skin.triangles[corner / 3][corner % 3];
    if (corners.root(corner) == corner) {
      point[corner] = static_cast<std::uint32_t>(node.size());
      node.push_back(skin.node[shown]);
      part.push_back(skin.part[shown]);
    }
    shown = point[corners.root(corner)];
  }
  skin.node = std::move(node);
  skin.part = std::move(part);
}

}  // namespace

Skin skin_of(const Topology& topology, const std::vector<Vec3d>& start) {
  Skin skin = surface_of(topology, start.size());
  if (std::holds_alternative<TetrahedralMesh>(topology)) divide_at_creases(skin, start);
  return skin;
}

}  // namespace mssim
