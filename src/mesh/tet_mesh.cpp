#include "mesh/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

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

namespace {

double six_volumes_of(const TetMesh& mesh, const Tetrahedron& nodes) {
  return six_volumes(mesh.nodes[nodes[0]], mesh.nodes[nodes[1]], mesh.nodes[nodes[2]], mesh.nodes[nodes[3]]);
}

/// Volume below which a tetrahedron of the same longest edge counts as flat: rounding decides its sign.
double flat_six_volumes(const TetMesh& mesh, const Tetrahedron& nodes) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, length(mesh.nodes[nodes[i]] - mesh.nodes[nodes[j]]));
  return 1e-10 * longest * longest * longest;
}

std::optional<MeshDefect> unused_node(const TetMesh& mesh) {
  std::vector<bool> used(mesh.nodes.size());
  for (const Tetrahedron& nodes : mesh.tetrahedra)
    for (const std::uint32_t node : nodes) used[node] = true;
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused == used.end()) return std::nullopt;
  return MeshDefect{MeshDefect::node, static_cast<std::size_t>(unused - used.begin()),
                    "no tetrahedron has this node; remove it"};
}

std::optional<MeshDefect> node_twice(const TetMesh& mesh) {
  std::vector<std::size_t> order(mesh.nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t n) {
    return std::tuple(mesh.nodes[n].x, mesh.nodes[n].y, mesh.nodes[n].z, n);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  const auto same = std::adjacent_find(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mesh.nodes[a] == mesh.nodes[b];
  });
  if (same == order.end()) return std::nullopt;
  return MeshDefect{MeshDefect::node, *(same + 1),
                    "another node is at " + place(mesh.nodes[*same]) + " too; merge the two"};
}

std::optional<MeshDefect> bad_volume(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double volume = six_volumes_of(mesh, mesh.tetrahedra[t]) / 6;
    const double flat = flat_six_volumes(mesh, mesh.tetrahedra[t]) / 6;
    if (volume > flat) continue;
    const bool is_flat = volume >= -flat;
    return MeshDefect{
        MeshDefect::tetrahedron, t,
        "the tetrahedron's volume is " + shown(volume) + " m^3" +
            (is_flat ? ": it is flat; move its nodes apart or remove it"
                     : " while others' are positive; list its nodes in the same sense as theirs")};
  }
  return std::nullopt;
}

std::optional<MeshDefect> crowded_face(const TetMesh& mesh) {
  const auto faces = faces_of(mesh);
  for (std::size_t f = 0; f + 2 < faces.size(); ++f) {
    if (faces[f] != faces[f + 2]) continue;
    const auto has_face = [&](Tetrahedron nodes) {
      std::sort(nodes.begin(), nodes.end());
      return std::includes(nodes.begin(), nodes.end(), faces[f].begin(), faces[f].end());
    };
    const auto last = std::find_if(mesh.tetrahedra.rbegin(), mesh.tetrahedra.rend(), has_face);
    return MeshDefect{
        MeshDefect::tetrahedron, static_cast<std::size_t>(mesh.tetrahedra.rend() - last) - 1,
        "the tetrahedron shares a face with two others or more; tetrahedra of a body do not overlap, so "
        "remove the duplicates"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<MeshDefect> find_defect(const TetMesh& mesh) {
  for (const auto find : {unused_node, node_twice, bad_volume, crowded_face})
    if (auto defect = find(mesh)) return defect;
  return std::nullopt;
}

void turn_if_mirrored(TetMesh& mesh) {
  const auto is_negative = [&](const Tetrahedron& nodes) {
    return six_volumes_of(mesh, nodes) < -flat_six_volumes(mesh, nodes);
  };
  if (!std::all_of(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), is_negative)) return;
  for (Tetrahedron& nodes : mesh.tetrahedra) std::swap(nodes[2], nodes[3]);
}

}  // namespace mssim
