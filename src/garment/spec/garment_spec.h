#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
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
#include "scene/fields/fields.h"

namespace mssim {

/// A boundary of a pattern piece as a scene file draws it.
struct BoundarySpec {
  bool is_bezier = false;     ///< a chain of cubics (Curve::bezier), or else a polyline
  std::vector<Vec3d> points;  ///< m, z = 0
};

/// A panel as a scene file describes it.
struct PieceSpec {
  std::string name;
  std::uint32_t rows = 0, columns = 0;  ///< of nodes
  std::uint32_t layer = 0;
  std::array<BoundarySpec, panel_edge_names.size()> boundaries;  ///< by PanelEdge
  bool behind = false;                                           ///< the body, or else before it
  double axis_m = 0;                                             ///< x at which the piece's x = 0 stands
  double distance_m = 0;                                         ///< PanelPlacement::distance
  double bend_radius_m = 0;                                      ///< PanelPlacement::radius
  std::optional<PanelMaterial> cloth;                            ///< none: the garment's
};

/// Panels and seams of one's own pattern.
struct PiecesSpec {
  std::vector<PieceSpec> panels;
  std::vector<Seam> seams;  ///< also to the panels of the jeans, where there are any
};

/// A dress form made from measures.
struct MannequinBody {
  BodyMeasures measures;
  std::uint32_t cells_around = 96;  ///< of the torso
};

/// A surface in an OBJ or STL file. Paths that are not absolute start at the scene file's folder.
struct BodyFile {
  std::string file;
  BodyStance stance;
  std::optional<double> close_holes_m;  ///< size of the largest opening that is closed; none: there are none
};

/// Jeans that fit the body: what the body itself says, its girths and the height of its crotch, is measured.
struct JeansSpec {
  std::uint32_t nodes = 0;  ///< about
  JeansMeasures measures;
};

/// A body, a garment for it, and how it is dressed.
struct GarmentSpec {
  std::variant<MannequinBody, BodyFile> body;
  double pixel_m = 0.0025;  ///< of the maps of the body
  double skin_m = 0.003;    ///< that the maps lie before the body's surface, beside what coarse cloth needs
  std::optional<JeansSpec> jeans;
  std::optional<PiecesSpec> pieces;  ///< one or both of the two
  PanelMaterial cloth;               ///< of jeans, and of pieces that have none of their own
  DressingSettings dressing;
  std::optional<ClothClothSettings> layers;  ///< that touch each other; none: they go through each other
  std::optional<MeshSize> expected;
};

/// Names the fields of pieces.
void visit_pieces(FieldVisitor& fields, PiecesSpec& pieces);

/// Names the fields of what panels are cut from.
void visit_cloth(FieldVisitor& fields, PanelMaterial& cloth);

/// Throws SceneError, which names the place under `pointer`, for a panel without a name, for boundaries that
/// are no curves, and for more than `most_nodes` nodes. What only cutting and sewing shows, build_garment
/// refuses.
void check_pieces(const std::filesystem::path& file, const std::string& pointer, const PiecesSpec& pieces,
                  std::uint64_t most_nodes);

/// Appends pieces that check_pieces accepts to a pattern. Those without a cloth of their own are of `cloth`.
void append_pieces(const PiecesSpec& pieces, const PanelMaterial& cloth, GarmentPattern& pattern);

}  // namespace mssim
