#include "garment/pattern/panel_springs.h"

#include <algorithm>
#include <cmath>

#include "geometry/geometry.h"
#include "model/topology.h"
#include "text/error.h"

namespace mssim {
namespace {

/// m^2, of the cell whose lower left corner is `node`
double cell_area(const PanelMesh& mesh, std::size_t node) {
  const Vec3d rising = mesh.nodes[node + mesh.columns + 1] - mesh.nodes[node];
  const Vec3d falling = mesh.nodes[node + mesh.columns] - mesh.nodes[node + 1];
  return 0.5 * cross(rising, falling).z;
}

/// Calls visit(lower left node) for each cell.
template <class Visit>
void for_each_cell(const PanelMesh& mesh, Visit visit) {
  for (std::size_t row = 0; row + 1 < mesh.rows; ++row)
    for (std::size_t column = 0; column + 1 < mesh.columns; ++column) visit(mesh.node(row, column));
}

}  // namespace

void require_cloth(const std::string& panel, const PanelMaterial& cloth) {
  const auto require = [&](double value, bool zero_too, const char* what) {
    if (!std::isfinite(value) || value < 0 || (value == 0 && !zero_too))
      throw InputError(panel + ": " + what + " is " + shown(value) + "; give a number " +
                       (zero_too ? "not below 0" : "above 0"));
  };
  const Waistband& band = cloth.waistband;
  require(cloth.area_density, false, "the cloth's area density");
  require(cloth.structural.stiffness, false, "the structural stiffness");
  require(cloth.shear.stiffness, true, "the shear stiffness");
  require(cloth.bending.stiffness, true, "the bending stiffness");
  require(cloth.structural.damping, true, "the structural damping");
  require(cloth.shear.damping, true, "the shear damping");
  require(cloth.bending.damping, true, "the bending damping");
  require(cloth.least_mass_share, true, "the nodes' least share of the mean mass");
  require(band.height, true, "the waistband's height");
  require(band.stiffness_factor, false, "the waistband's stiffness factor");
  require(band.mass_factor, false, "the waistband's mass factor");
  require(band.seam_factor, false, "the waistband's seam factor");
}

std::uint32_t waistband_rows(const PanelMesh& mesh, const Waistband& waistband) {
  if (!(waistband.height > 0)) return 0;
  const std::vector<double>&at_left = mesh.arcs_on(PanelEdge::left),
        &at_right = mesh.arcs_on(PanelEdge::right);
  constexpr double rounding = 1e-9;
  std::uint32_t rows = 1;
  while (rows < mesh.rows) {
    const std::size_t row = mesh.rows - 1 - rows;
    const double below = 0.5 * (at_left.back() - at_left[row] + at_right.back() - at_right[row]);
    if (below > waistband.height + rounding) break;
    ++rows;
  }
  return rows;
}

void append_springs(const GarmentPanel& panel, const PanelMesh& mesh, const PanelMaterial& cloth,
                    std::vector<Spring>& springs, std::vector<SpringMaterial>& materials) {
  const auto first_material = static_cast<std::uint32_t>(materials.size());
  materials.insert(materials.end(), {cloth.structural, cloth.shear, cloth.bending});
  const std::uint32_t hoop = first_material + 3;
  const std::uint32_t band_rows = waistband_rows(mesh, cloth.waistband);
  if (band_rows > 0)
    materials.push_back(
        {cloth.structural.stiffness * cloth.waistband.stiffness_factor, cloth.structural.damping});
  const std::size_t band_begin = mesh.node(mesh.rows - band_rows, 0);
  for (Spring spring : springs_of(GridPatch{mesh.rows, mesh.columns, 1})) {
    const bool along_a_row = spring.kind == structural && spring.second == spring.first + 1;
    spring.kind = along_a_row && spring.first >= band_begin ? hoop : first_material + spring.kind;
    spring.rest_length = static_cast<float>(length(mesh.nodes[spring.second] - mesh.nodes[spring.first]));
    spring.first += panel.first_node;
    spring.second += panel.first_node;
    springs.push_back(spring);
  }
}

std::vector<double> node_masses(const PanelMesh& mesh, const PanelMaterial& cloth) {
  std::vector<double> masses(mesh.nodes.size(), 0);
  for_each_cell(mesh, [&](std::size_t node) {
    const double fraction = 0.25 * cell_area(mesh, node) * cloth.area_density;
    for (const std::size_t corner : {node, node + 1, node + mesh.columns, node + mesh.columns + 1})
      masses[corner] += fraction;
  });
  const double mean = area_of(mesh) * cloth.area_density / static_cast<double>(masses.size());
  const std::size_t band_begin = mesh.node(mesh.rows - waistband_rows(mesh, cloth.waistband), 0);
  for (std::size_t node = 0; node < masses.size(); ++node) {
    masses[node] = std::max(masses[node], cloth.least_mass_share * mean);
    if (node >= band_begin) masses[node] *= cloth.waistband.mass_factor;
  }
  return masses;
}

double area_of(const PanelMesh& mesh) {
  double area = 0;
  for_each_cell(mesh, [&](std::size_t node) { area += cell_area(mesh, node); });
  return area;
}

}  // namespace mssim
