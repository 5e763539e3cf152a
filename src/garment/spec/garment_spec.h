#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "garment/body/mannequin.h"
#include "garment/body/stance.h"
#include "garment/garment.h"
#include "garment/pattern/garment_build.h"
#include "garment/pattern/jeans.h"
#include "geometry/vec3.h"
#include "mesh/meshing.h"

namespace mssim {

/// A boundary of a pattern piece as a scene file draws it.
struct BoundarySpec {
  bool is_bezier = false;     ///< a chain of cubics (Curve::bezier), or else a polyline
  std::vector<Vec3d> points;  ///< m, z = 0
};

/// A panel as a scene file describes it.
struct PieceSpec {
  std::string name;
  PanelGrid grid;
  std::uint32_t layer = 0;
  std::array<BoundarySpec, panel_edge_names.size()> boundaries;  ///< by PanelEdge
  PanelPlacement placement;
  std::optional<PanelMaterial> cloth;  ///< none: the garment's
};

/// Panels and seams of the user's own pattern.
struct PiecesSpec {
  std::vector<PieceSpec> panels;
  std::vector<Seam> seams;  ///< also to the panels of the jeans, if any
};

/// A dress form made from measures.
struct MannequinBody {
  BodyMeasures measures;
  std::uint32_t cells_around = 96;  ///< of the torso
};

/// A surface in an OBJ or STL file. Relative paths start at the scene file's folder.
struct BodyFile {
  std::string file;
  BodyStance stance;
  std::optional<double> close_holes_m;  ///< size of the largest opening to close; none: it must be closed
};

/// Jeans that fit the body. The body's girths and the height of its crotch are measured on it.
struct JeansSpec {
  std::uint32_t nodes = 0;  ///< about
  JeansMeasures measures;
};

struct SceneKind;

/// A body, a garment for it, and how it is dressed.
struct GarmentSpec {
  std::variant<MannequinBody, BodyFile> body;
  double pixel_m = 0.0025;  ///< of the maps of the body
  double skin_m = 0.003;    ///< distance of the maps from the body's surface, besides what coarse cloth needs
  std::optional<JeansSpec> jeans;
  std::optional<PiecesSpec> pieces;  ///< one or both of the two
  PanelMaterial cloth;               ///< of jeans, and of pieces without their own cloth
  DressingSettings dressing;
  std::optional<ClothClothSettings> layers;  ///< none: they pass through each other
  std::optional<MeshSize> expected;

  static const SceneKind kind;  ///< scene/spec/scene_spec.h
};

}  // namespace mssim
