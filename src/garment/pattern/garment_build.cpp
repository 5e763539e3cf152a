#include "garment/pattern/garment_build.h"

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

/// What building a garment knows beside the result.
struct Workshop {
  std::vector<PanelMesh> meshes;  ///< [panels]
  std::vector<double> strengths;  ///< [nodes] factors of the seams' force
};

void add_panel(const PatternPanel& panel, const BodyDepth& body, Workshop& workshop, GarmentBuild& build) {
  Garment& garment = build.garment;
  const std::string& name = panel.piece.name;
  for (const GarmentPanel& other : garment.panels)
    if (other.name == name) throw InputError(name + ": two panels have this name; rename one of them");
  require_cloth(name, panel.cloth);
  const PanelMesh& mesh = workshop.meshes.emplace_back(mesh_panel(panel.piece, panel.grid));
  garment.panels.push_back(
      {name, mesh.rows, mesh.columns, static_cast<std::uint32_t>(garment.flat.size()), panel.layer});
  append(garment.flat, mesh.nodes);
  append(build.placed, place_panel(name, mesh, panel.placement, body));
  append(build.node_mass, node_masses(mesh, panel.cloth));
  append(workshop.strengths, seam_factors(mesh, panel.cloth.waistband));
  append_springs(garment.panels.back(), mesh, panel.cloth, build.springs, build.materials);
}

void add_seam(const Seam& seam, const Workshop& workshop, Garment& garment) {
  std::vector<Joint> joints =
      join_seam(seam, garment.panels, workshop.meshes, static_cast<std::uint32_t>(garment.seams.size()));
  for (Joint& joint : joints) joint.strength = workshop.strengths[joint.node];
  garment.seams.push_back(seam.name);
  append(garment.joints, joints);
}

/// Calls `add` with each part, and says of which one it does not take.
template <class Parts, class Add>
void add_each(const Parts& parts, PatternError::Part kind, const Add& add) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    try {
      add(parts[i]);
    } catch (const InputError& error) {
      throw PatternError(error, kind, i);
    }
  }
}

}  // namespace

GarmentBuild build_garment(const GarmentPattern& pattern, const BodyDepth& body) {
  GarmentBuild build;
  Workshop workshop;
  add_each(pattern.panels, PatternError::Part::panel,
           [&](const PatternPanel& panel) { add_panel(panel, body, workshop, build); });
  add_each(pattern.seams, PatternError::Part::seam,
           [&](const Seam& seam) { add_seam(seam, workshop, build.garment); });
  build.garment.close = close_cloth(pattern.close, build.garment);
  return build;
}

}  // namespace mssim
