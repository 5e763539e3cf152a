// Meshes in TetGen's files: .node, form feed, .ele.

#include <cmath>
#include <string>

#include "fuzz_checks.h"
#include "mesh/tetgen.h"
#include "text/error.h"

namespace mssim {
namespace {

void check(const TetMesh& mesh) {
  require(!mesh.nodes.empty() && !mesh.tetrahedra.empty(), "a mesh has nodes and tetrahedra");
  for (const Vec3d& node : mesh.nodes) require(is_finite(node), "nodes are finite");
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra)
    for (const std::uint32_t corner : tetrahedron) require(corner < mesh.nodes.size(), "corners are nodes");
  require(std::isfinite(volume_of(mesh)) && volume_of(mesh) > 0, "a mesh has a volume");
  for (const auto& [a, b] : edges_of(mesh)) {
    require(a < b && b < mesh.nodes.size(), "an edge joins two nodes");
    const double edge = length(mesh.nodes[b] - mesh.nodes[a]);
    require(std::isfinite(edge) && edge > 0, "an edge has a length");
  }
  const double angle = smallest_dihedral_angle(mesh);
  require(angle >= 0 && angle <= 90, "a tetrahedron has an angle of at most that of the regular one");

  const std::string nodes = node_text(mesh.nodes), tetrahedra = ele_text(mesh.tetrahedra);
  const TetMesh again = parse_tetgen_files({"again.node", nodes}, {"again.ele", tetrahedra});
  require(again.nodes == mesh.nodes && again.tetrahedra == mesh.tetrahedra, "written meshes read back");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto [nodes, tetrahedra] = two_texts(text_of(data, size));
  const auto mesh = unless_refused<InputError>([&, node_text = nodes, ele_text = tetrahedra] {
    return parse_tetgen_files({"fuzz.node", node_text}, {"fuzz.ele", ele_text});
  });
  if (mesh) check(*mesh);
  return 0;
}

}  // namespace mssim
