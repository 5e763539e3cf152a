#include "output/pictures/skin.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/disjoint_sets.h"

namespace mssim {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Two triangles a cell, from consecutive nodes, row by row.
void add_grid(Skin& skin, std::string name, std::uint32_t first_node, std::uint32_t rows,
              std::uint32_t columns) {
  const auto first = static_cast<std::uint32_t>(skin.node.size());
  for (std::uint32_t i = 0; i < rows * columns; ++i) skin.node.push_back(first_node + i);
  skin.part.resize(skin.node.size(), static_cast<std::uint32_t>(skin.parts.size()));
  skin.parts.push_back(std::move(name));
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t a = first + row * columns + column, b = a + 1, c = a + columns, d = c + 1;
      skin.triangles.push_back({a, b, d});
      skin.triangles.push_back({a, d, c});
    }
}

/// The faces that belong to one tetrahedron, outwards.
std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<std::pair<Triangle, Triangle>> faces;  // its corners in order, and as it is
  faces.reserve(4 * tetrahedra.size());
  for (const auto& [a, b, c, d] : tetrahedra)
    for (const Triangle& face :
         {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{a, d, c}, Triangle{b, c, d}}) {
      Triangle key = face;
      std::ranges::sort(key);
      faces.emplace_back(key, face);
    }
  std::ranges::sort(faces);
  std::vector<Triangle> boundary;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].first == faces[i].first) ++end;
    if (end == i + 1) boundary.push_back(faces[i].second);
    i = end;
  }
  return boundary;
}

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

/// [nodes] which body each belongs to, from 0 on in the order of their first nodes.
std::vector<std::uint32_t> bodies_of(const std::vector<Tetrahedron>& tetrahedra, std::size_t nodes) {
  DisjointSets sets(nodes);
  for (const Tetrahedron& corners : tetrahedra)
    for (const std::uint32_t corner : corners) sets.unite(corners[0], corner);
  std::vector<std::uint32_t> body(nodes);
  std::map<std::uint32_t, std::uint32_t> number;
  for (std::uint32_t node = 0; node < nodes; ++node)
    body[node] = number.try_emplace(sets.root(node), static_cast<std::uint32_t>(number.size())).first->second;
  return body;
}

Skin skin_of_bodies(const std::vector<Tetrahedron>& tetrahedra, const std::vector<Vec3d>& start) {
  Skin skin;
  skin.triangles = boundary_of(tetrahedra);
  const std::vector<std::uint32_t> body = bodies_of(tetrahedra, start.size());
  DisjointSets corners = smooth_corners(skin.triangles, start);
  std::vector<std::uint32_t> point(3 * skin.triangles.size());
  for (std::uint32_t corner = 0; corner < point.size(); ++corner) {
    std::uint32_t& node_or_point = skin.triangles[corner / 3][corner % 3];
    if (corners.root(corner) == corner) {
      point[corner] = static_cast<std::uint32_t>(skin.node.size());
      skin.node.push_back(node_or_point);
      skin.part.push_back(body[node_or_point]);
    }
    node_or_point = point[corners.root(corner)];
  }
  for (std::uint32_t i = 0; i < 1 + std::ranges::max(body); ++i)
    skin.parts.push_back("body " + std::to_string(i + 1));
  return skin;
}

}  // namespace

Skin skin_of(const Topology& topology, const std::vector<Vec3d>& start) {
  Skin skin;
  if (const auto* grid = std::get_if<GridPatch>(&topology))
    add_grid(skin, "cloth", 0, grid->rows, grid->columns);
  else if (const auto* garment = std::get_if<Garment>(&topology))
    for (const GarmentPanel& panel : garment->panels)
      add_grid(skin, panel.name, panel.first_node, panel.rows, panel.columns);
  else
    skin = skin_of_bodies(std::get<TetrahedralMesh>(topology).tetrahedra, start);
  return skin;
}

}  // namespace mssim
