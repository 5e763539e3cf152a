#include "model/node_shape.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "geometry/geometry.h"

namespace mssim {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Two triangles per cell.
void add_sheet(NodeSurface& surface, const GarmentPanel& sheet) {
  const auto first = static_cast<std::uint32_t>(surface.node.size());
  for (std::uint32_t i = 0; i < sheet.nodes(); ++i) surface.node.push_back(sheet.first_node + i);
  surface.part.resize(surface.node.size(), static_cast<std::uint32_t>(surface.parts.size()));
  surface.parts.push_back(sheet.name);
  for (std::uint32_t row = 0; row + 1 < sheet.rows; ++row)
    for (std::uint32_t column = 0; column + 1 < sheet.columns; ++column)
      for (const std::uint32_t half : {0U, 1U})
        for (std::uint32_t& corner : surface.triangles.emplace_back(sheet.triangle(row, column, half)))
          corner = first + (corner - sheet.first_node);
}

/// The faces that belong to one tetrahedron only, facing outwards.
std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<std::pair<Triangle, Triangle>> faces;  // the face's sorted corners, and the face
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

NodeSurface surface_of_bodies(const std::vector<Tetrahedron>& tetrahedra, std::size_t nodes) {
  NodeSurface surface;
  surface.triangles = boundary_of(tetrahedra);
  for (const Triangle& triangle : surface.triangles)
    surface.node.insert(surface.node.end(), triangle.begin(), triangle.end());
  std::ranges::sort(surface.node);
  surface.node.erase(std::unique(surface.node.begin(), surface.node.end()), surface.node.end());
  std::vector<std::uint32_t> point(nodes);
  for (std::uint32_t i = 0; i < surface.node.size(); ++i) point[surface.node[i]] = i;
  for (Triangle& triangle : surface.triangles)
    for (std::uint32_t& corner : triangle) corner = point[corner];
  const std::vector<std::uint32_t> body = bodies_of(tetrahedra, nodes);
  for (const std::uint32_t node : surface.node) surface.part.push_back(body[node]);
  for (std::uint32_t i = 0; i < 1 + std::ranges::max(body); ++i)
    surface.parts.push_back(fmt::format("body {}", i + 1));
  return surface;
}

}  // namespace

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

NodeShape shape_of(const Topology& topology) {
  struct Kinds {
    NodeShape operator()(const GridPatch& grid) const {
      return {"cloth", {{"cloth", grid.rows, grid.columns}}, {}, false};
    }
    NodeShape operator()(const TetrahedralMesh& mesh) const { return {"bodies", {}, mesh.tetrahedra, false}; }
    NodeShape operator()(const Garment& garment) const { return {"garment", garment.panels, {}, true}; }
  };
  return std::visit(Kinds{}, topology);
}

void require_fitting_shape(const NodeShape& shape, std::size_t nodes) {
  if (nodes == 0) throw std::invalid_argument("a trace needs nodes");
  if (shape.sheets.empty() && !shape.in_panels) {
    const bool fits = std::ranges::all_of(shape.tetrahedra, [&](const Tetrahedron& corners) {
      return std::ranges::all_of(corners, [&](std::uint32_t corner) { return corner < nodes; });
    });
    if (shape.tetrahedra.empty() || !fits)
      throw std::invalid_argument("a trace of bodies needs tetrahedra between its nodes");
    return;
  }
  std::size_t next = 0;
  for (const GarmentPanel& sheet : shape.sheets) {
    if (shape.in_panels && (sheet.rows < 2 || sheet.columns < 2 || sheet.first_node != next))
      throw std::invalid_argument("a trace needs panels of rows and columns, in order");
    next += std::size_t{sheet.rows} * sheet.columns;
  }
  if (next != nodes)
    throw std::invalid_argument(shape.in_panels ? "a trace needs panels of all nodes"
                                                : "a trace needs a grid of all nodes");
}

NodeSurface surface_of(const NodeShape& shape, std::size_t nodes) {
  if (shape.sheets.empty() && !shape.in_panels) return surface_of_bodies(shape.tetrahedra, nodes);
  NodeSurface surface;
  for (const GarmentPanel& sheet : shape.sheets) add_sheet(surface, sheet);
  return surface;
}

}  // namespace mssim
