#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "garment/garment.h"
#include "geometry/vec3.h"
#include "model/system.h"
#include "text/error.h"

namespace mssim {

/// A curve in the plane of a pattern (z = 0; m): a polyline, whose points are found by their arc length.
class Curve {
 public:
  /// Chords of one Bezier segment. One that turns by a right angle comes out shorter by 6e-6 of its length.
  static constexpr std::size_t chords = 128;

  /// Throws InputError unless there are two points or more, all finite, with z = 0, each apart from the next.
  explicit Curve(std::vector<Vec3d> points);

  /// A chain of cubic Bezier segments: end point, two control points, end point, two control points, ..., end
  /// point, as a polyline of `chords` chords each. Throws InputError unless there are 3 n + 1 points with n >
  /// 0.
  static Curve bezier(std::span<const Vec3d> points);

  /// m
  double length() const { return arcs_.back(); }
  const Vec3d& first() const { return points_.front(); }
  const Vec3d& last() const { return points_.back(); }
  const std::vector<Vec3d>& points() const { return points_; }

  /// The point at this fraction of the arc length; exactly the ends for 0 and 1, and for what lies beyond.
  Vec3d at(double fraction) const;

  /// This curve and then that one, which begins where this one ends.
  Curve followed_by(const Curve& next) const;

  /// The curve with x negated: a left panel's boundary becomes a right one's.
  Curve mirrored() const;

 private:
  std::vector<Vec3d> points_;
  std::vector<double> arcs_;  ///< m, from the first point to each
};

/// The four boundaries of a pattern piece. The numbers index panel_edge_names.
enum class PanelEdge : std::uint32_t { bottom, top, left, right };
inline constexpr std::array<std::string_view, 4> panel_edge_names{"bottom", "top", "left", "right"};

inline std::string name_of(PanelEdge edge) {
  return std::string(panel_edge_names.at(static_cast<std::size_t>(edge)));
}

/// A pattern piece, drawn as it is seen from outside when it is worn. Its boundaries meet at four corners, to
/// a tenth of a millimetre.
struct PatternPiece {
  std::string name;
  Curve bottom, top;  ///< from left to right
  Curve left, right;  ///< from bottom to top
};

/// A row that must end at given places.
struct GridLine {
  std::uint32_t index = 0;  ///< of the row, neither the first nor the last
  double first = 0;         ///< fraction of the left boundary's arc length
  double second = 0;        ///< fraction of the right boundary's
};

/// How a piece is cut into cells. Between the rows that are given the others are spread evenly, as columns
/// are.
struct PanelGrid {
  std::uint32_t rows = 0;  ///< of nodes
  std::uint32_t columns = 0;
  std::vector<GridLine> row_lines{};  ///< ascending
};

/// A pattern piece as nodes in its plane.
struct PanelMesh {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  /// m, z = 0; row-major, row 0 at the bottom, column 0 at the left; rounded to micrometres
  std::vector<Vec3d> nodes;
  /// m, by PanelEdge: how far along its boundary each node of an edge lies
  std::array<std::vector<double>, 4> arcs;

  const std::vector<double>& arcs_on(PanelEdge edge) const { return arcs.at(static_cast<std::size_t>(edge)); }
  std::size_t node(std::size_t row, std::size_t column) const { return row * columns + column; }
  /// The nodes of an edge in the order of its boundary.
  std::vector<std::size_t> edge_nodes(PanelEdge edge) const;
};

/// Thrown for boundaries that leave a piece no room for its cells.
struct FoldedPiece : InputError {
  using InputError::InputError;
};

/// The bilinearly blended patch of Coons ("Surfaces for computer-aided design of space forms", MIT MAC-TR-41,
/// 1967) between the four boundaries. Cells are convex and go round counter-clockwise. Throws InputError,
/// which begins with the panel's name, for fewer than two rows or columns, corners that do not meet and grid
/// lines that are out of order, and as FoldedPiece for boundaries that cross and cells that fold over.
PanelMesh mesh_panel(const PatternPiece& piece, const PanelGrid& grid);

/// What of a pattern is to lie close to the body: cloth beside these seams.
struct CloseSeams {
  std::vector<std::string> seams;  ///< their names
  double reach = 0;                ///< m, how far beside a seam, along a row in the flat pattern
  double lowest = 0, highest = 0;  ///< m, heights on the body, both included
};

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

/// How deep the body is at a height y: z of its foremost and hindmost point, m. The functions answer for
/// every height that a panel reaches.
struct BodyDepth {
  std::function<double(double)> front, back;
};

/// Where a panel begins: before or behind the body, bent round an upright cylinder. A panel keeps the heights
/// that it was drawn at.
struct PanelPlacement {
  bool behind = false;
  /// m, x at which the pattern's x = 0 stands, by height; its sign says on which side of the body
  std::function<double(double)> axis = [](double) { return 0.0; };
  double distance = 0.03;  ///< m, from the body's foremost (hindmost) point at that height
  double radius = 0.105;   ///< m, of the bend
};

/// The nodes of a panel in space, m, rounded to micrometres. Its outside looks away from the body. The half
/// that looks to the plane x = 0 bends by no more than two thirds of the distance and runs straight on from
/// there, so that it stays before everything that the body has at its height: trunk and other leg are there.
/// Throws InputError, which begins with `panel`, where the body has no finite depth and for a distance or
/// radius that is not positive.
std::vector<Vec3d> place_panel(const std::string& panel, const PanelMesh& mesh,
                               const PanelPlacement& placement, const BodyDepth& body);

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
