#include "mesh/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/geometry.h"

namespace mssim {

std::vector<std::array<std::uint32_t, 2>> edges_of(const TetMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(6 * mesh.tetrahedra.size());
  for (const Tetrahedron& nodes : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        edges.push_back({std::min(nodes[i], nodes[j]), std::max(nodes[i], nodes[j])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<std::array<std::uint32_t, 3>> faces_of(const TetMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    for (std::array<std::uint32_t, 3> face : {std::array{b, c, d}, {a, c, d}, {a, b, d}, {a, b, c}}) {
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  return faces;
}

double volume_of(const TetMesh& mesh) {
  double six_times = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    six_times += six_volumes(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c], mesh.nodes[d]);
  return six_times / 6;
}

double smallest_dihedral_angle(const TetMesh& mesh) {
  double largest_cosine = -1;
  for (const Tetrahedron& nodes : mesh.tetrahedra) {
    const Vec3d& a = mesh.nodes[nodes[0]];
    const Vec3d ab = mesh.nodes[nodes[1]] - a;
    const Vec3d ac = mesh.nodes[nodes[2]] - a;
    const Vec3d ad = mesh.nodes[nodes[3]] - a;
    // Outward normals of the four faces; the angle between two faces is 180 degrees less that of their
    // normals.
    const std::array normals{cross(ac - ab, ad - ab), cross(ad, ac), cross(ab, ad), cross(ac, ab)};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        largest_cosine = std::max(largest_cosine,
                                  -dot(normals[i], normals[j]) / (length(normals[i]) * length(normals[j])));
  }
  return std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

std::int64_t euler_characteristic(const TetMesh& mesh) {
  auto faces = faces_of(mesh);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return static_cast<std::int64_t>(mesh.nodes.size()) - static_cast<std::int64_t>(edges_of(mesh).size()) +
         static_cast<std::int64_t>(faces.size()) - static_cast<std::int64_t>(mesh.tetrahedra.size());
}

}  // namespace mssim
