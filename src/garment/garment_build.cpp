#include "garment/garment_build.h"

#include "mesh/mesh_error.h"

namespace mssim {
namespace {

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The factor of the seams' force on each node.
std::vector<double> seam_factors(const PanelMesh& mesh, const Waistband& waistband) {
  std::vector<double> factors(mesh.nodes.size(), 1);
  for (std::size_t node = mesh.node(mesh.rows - waistband_rows(mesh, waistband), 0); node < factors.size();
       ++node)
    factors[node] = waistband.seam_factor;
  return factors;
}

}  // namespace

GarmentBuild build_garment(const GarmentPattern& pattern, const BodyDepth& body) {
  GarmentBuild build;
  Garment& garment = build.garment;
  std::vector<PanelMesh> meshes;
  std::vector<double> strengths;
  for (const PatternPanel& panel : pattern.panels) {
    const std::string& name = panel.piece.name;
    for (const GarmentPanel& other : garment.panels)
      if (other.name == name) throw MeshError(name + ": two panels have this name; rename one of them");
    require_cloth(name, panel.cloth);
    const PanelMesh& mesh = meshes.emplace_back(mesh_panel(panel.piece, panel.grid));
    garment.panels.push_back(
        {name, mesh.rows, mesh.columns, static_cast<std::uint32_t>(build.flat.size()), panel.layer});
    append(build.flat, mesh.nodes);
    append(build.placed, place_panel(name, mesh, panel.placement, body));
    append(build.node_mass, node_masses(mesh, panel.cloth));
    append(strengths, seam_factors(mesh, panel.cloth.waistband));
    append_springs(garment.panels.back(), mesh, panel.cloth, build.springs, build.materials);
  }
  for (const Seam& seam : pattern.seams) {
    std::vector<Joint> joints =
        join_seam(seam, garment.panels, meshes, static_cast<std::uint32_t>(garment.seams.size()));
    for (Joint& joint : joints) joint.strength = strengths[joint.node];
    garment.seams.push_back(seam.name);
    append(garment.joints, joints);
  }
  return build;
}

}  // namespace mssim
