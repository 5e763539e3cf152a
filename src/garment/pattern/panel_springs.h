#pragma once

#include <string>
#include <vector>

#include "garment/garment.h"
#include "garment/pattern/panel_mesh.h"
#include "model/system.h"

namespace mssim {

/// The rows of a panel next to its top boundary, which hold the garment on the body.
struct Waistband {
  double height = 0;            ///< m; 0 is no waistband
  double stiffness_factor = 8;  ///< of the structural springs along its rows
  double mass_factor = 4;       ///< of its nodes: the largest time step stays about what it is elsewhere
  double seam_factor = 4;       ///< of the seams' force on its nodes (Joint::strength)
};

/// What a panel is cut from. Defaults are denim's, as light as a garment needs it to settle quickly.
struct PanelMaterial {
  double area_density = 0.40;  ///< kg/m^2
  SpringMaterial structural{200, 0};
  SpringMaterial shear{60, 0};
  SpringMaterial bending{8, 0};
  /// A node's mass is at least this share of the panel's mean one. At 0 the masses sum to the panel's; nodes
  /// on the boundary then weigh half or a quarter, which shortens the largest stable time step. At 1 they
  /// weigh what the others do: hems and seams are several layers of cloth.
  double least_mass_share = 0;
  Waistband waistband{};
};

/// How many rows from the top one down belong to the waistband: those that end within its height of the top
/// corners, taking the mean of left and right, and the top row in any case. 0 without a waistband.
std::uint32_t waistband_rows(const PanelMesh& mesh, const Waistband& waistband);

/// Throws InputError, which names the panel, field and remedy, unless density, stiffnesses and factors are
/// positive and finite, and dampings, shares and the waistband's height not negative.
void require_cloth(const std::string& panel, const PanelMaterial& cloth);

/// Appends the springs of the 12-neighbour stencil in the order of springs_of(GridPatch), each as long at
/// rest as its ends are apart in the plane of the pattern, and to `materials` those of the panel: structural,
/// shear, bending and, with a waistband, its rows' structural one.
void append_springs(const GarmentPanel& panel, const PanelMesh& mesh, const PanelMaterial& cloth,
                    std::vector<Spring>& springs, std::vector<SpringMaterial>& materials);

/// kg, of each node: a quarter of each cell that it belongs to, times the density.
std::vector<double> node_masses(const PanelMesh& mesh, const PanelMaterial& cloth);

/// m^2, of all cells
double area_of(const PanelMesh& mesh);

}  // namespace mssim
