#include "commands/bench/structure.h"

#include <stdexcept>
#include <variant>

#include "mesh/tet_mesh.h"

namespace mssim {

StructureRow structure_of(const PreparedScene& scene) {
  const auto* mesh = std::get_if<TetrahedralMesh>(&scene.system.topology);
  if (mesh == nullptr) throw std::invalid_argument(scene.spec.name + " has no tetrahedra");
  StructureRow row;
  row.scene = scene.spec.name;
  row.nodes = scene.counts.nodes;
  row.springs_unique = scene.counts.springs_unique;
  row.springs_published = scene.counts.springs_published.value();
  row.tetrahedra = mesh->tetrahedra.size();
  // At the start a body is turned and moved, but not deformed.
  row.smallest_dihedral_angle_deg = smallest_dihedral_angle({scene.system.start.position, mesh->tetrahedra});
  return row;
}

}  // namespace mssim
