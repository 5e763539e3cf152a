#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "garment/garment.h"
#include "garment/pattern/close_cloth.h"
#include "garment/pattern/panel_mesh.h"
#include "garment/pattern/panel_springs.h"
#include "garment/pattern/placement.h"
#include "garment/pattern/seams.h"
#include "model/system.h"
#include "text/error.h"

namespace mssim {

/// A pattern piece with all that makes it a part of a garment.
struct PatternPanel {
  PatternPiece piece;
  PanelGrid grid{};
  PanelMaterial cloth{};
  PanelPlacement placement{};
  std::uint32_t layer = 0;
};

/// A garment as it is drawn and cut.
struct GarmentPattern {
  std::vector<PatternPanel> panels;
  std::vector<Seam> seams;
  CloseSeams close = {};
};

/// A garment as it is simulated. Vectors over nodes go panel by panel.
struct GarmentBuild {
  Garment garment;
  std::vector<Vec3d> placed;      ///< m, where the nodes start
  std::vector<double> node_mass;  ///< kg
  std::vector<Spring> springs;    ///< panel by panel; kind is an index into materials
  std::vector<SpringMaterial> materials;
};

/// Thrown for a panel or a seam of a pattern that cannot be used. what() begins with its name.
struct PatternError : InputError {
  enum class Part { panel, seam };
  PatternError(const InputError& error, Part part_, std::size_t index_)
      : InputError(error),
        part(part_),
        index(index_),
        folded(dynamic_cast<const FoldedPiece*>(&error) != nullptr) {}

  Part part;
  std::size_t index;  ///< into the pattern's panels or seams
  bool folded;        ///< a FoldedPiece
};

/// Cuts, sews and places a pattern. Throws PatternError for what mesh_panel, require_cloth, join_seam and
/// place_panel refuse, and for two panels of one name.
GarmentBuild build_garment(const GarmentPattern& pattern, const BodyDepth& body);

}  // namespace mssim
