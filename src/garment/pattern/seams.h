#pragma once

#include <span>
#include <string>
#include <vector>

#include "garment/garment.h"
#include "garment/pattern/panel_mesh.h"

namespace mssim {

/// A part of a panel's boundary. With from > to it is passed backwards.
struct SeamStretch {
  std::string panel;
  PanelEdge edge = PanelEdge::left;
  double from = 0;  ///< fraction of the boundary's arc length
  double to = 1;
};

/// Two stretches that are sewn together, the beginning of one to the beginning of the other.
struct Seam {
  std::string name;
  SeamStretch first, second;
  /// How much the lengths of the two may differ, as a fraction of the longer one; what is longer is eased in.
  double tolerance = 0.03;
};

/// The joints of a seam (Vassilev, "Cloth simulation"): each node of the stretch with more of them (of
/// `first` where both have as many), once, is joined to the place at the same fraction of the other's length,
/// which is a node where one lies within a twentieth of the edge, and at both ends. A stretch ends at the
/// nodes that are nearest to its ends. The lengths of the joints sum to the length of the finer stretch.
///
/// `panels` and `meshes` belong to each other; `seam_index` becomes Joint::seam. Throws InputError, which
/// begins with "seam NAME", for an unknown panel, a stretch outside its boundary or with less than two nodes,
/// one that is sewn to itself, and lengths that differ by more than the tolerance.
std::vector<Joint> join_seam(const Seam& seam, std::span<const GarmentPanel> panels,
                             std::span<const PanelMesh> meshes, std::uint32_t seam_index);

}  // namespace mssim
