#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "garment/garment.h"
#include "geometry/vec3.h"
#include "model/system.h"
#include "text/error.h"

namespace mssim {

/// A curve in the plane of a pattern (z = 0; m): a polyline, parametrised by arc length.
class Curve {
 public:
  /// Chords per Bezier segment. A segment that turns by a right angle loses 6e-6 of its length.
  static constexpr std::size_t chords = 128;

  /// Throws InputError unless there are two or more points, all finite, with z = 0, each unlike the next.
  explicit Curve(std::vector<Vec3d> points);

  /// A chain of cubic Bezier segments, each as `chords` chords: end point, two control points, end point, two
  /// control points, ..., end point. Throws InputError unless there are 3 n + 1 points with n > 0.
  static Curve bezier(std::span<const Vec3d> points);

  /// m
  double length() const { return arcs_.back(); }
  const Vec3d& first() const { return points_.front(); }
  const Vec3d& last() const { return points_.back(); }
  const std::vector<Vec3d>& points() const { return points_; }

  /// The point at this fraction of the arc length; exactly an end point for 0, for 1 and beyond.
  Vec3d at(double fraction) const;

  /// This curve followed by `next`, which starts at this one's end.
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

/// The name of a boundary in scene files.
inline std::string name_of(PanelEdge edge) {
  return std::string(panel_edge_names.at(static_cast<std::size_t>(edge)));
}

/// A pattern piece, drawn as seen from outside when worn. Its boundaries meet at four corners, to 0.1 mm.
struct PatternPiece {
  std::string name;
  Curve bottom, top;  ///< from left to right
  Curve left, right;  ///< from bottom to top
};

/// A row with given ends.
struct GridLine {
  std::uint32_t index = 0;  ///< of the row, neither the first nor the last
  double first = 0;         ///< fraction of the left boundary's arc length
  double second = 0;        ///< fraction of the right boundary's
};

/// The cells of a piece. Rows without given ends are evenly spaced between those with given ends; columns are
/// evenly spaced.
struct PanelGrid {
  std::uint32_t rows = 0;  ///< of nodes
  std::uint32_t columns = 0;
  std::vector<GridLine> row_lines{};  ///< ascending
};

/// The largest number of rows or columns.
inline constexpr std::uint32_t most_panel_lines = 10'000;

/// A pattern piece as nodes in its plane.
struct PanelMesh {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  /// m, z = 0; row-major, row 0 at the bottom, column 0 at the left; rounded to micrometres
  std::vector<Vec3d> nodes;
  /// m, by PanelEdge: the arc length of each node of an edge along its boundary
  std::array<std::vector<double>, 4> arcs;

  const std::vector<double>& arcs_on(PanelEdge edge) const { return arcs.at(static_cast<std::size_t>(edge)); }
  std::size_t node(std::size_t row, std::size_t column) const { return row * columns + column; }
  /// The nodes of an edge in the order of its boundary.
  std::vector<std::size_t> edge_nodes(PanelEdge edge) const;
};

/// Thrown for boundaries that cross and for cells that fold over.
struct FoldedPiece : InputError {
  using InputError::InputError;
};

/// The bilinearly blended patch of Coons ("Surfaces for computer-aided design of space forms", MIT MAC-TR-41,
/// 1967) between the four boundaries. Cells are convex and counter-clockwise. Throws InputError, which starts
/// with the panel's name, for fewer than two rows or columns, corners that do not meet and grid lines out of
/// order, and FoldedPiece for boundaries that cross and cells that fold over.
PanelMesh mesh_panel(const PatternPiece& piece, const PanelGrid& grid);

/// The cloth of a pattern that must lie close to the body: next to these seams.
struct CloseSeams {
  std::vector<std::uint32_t> seams;  ///< indices into GarmentPattern::seams
  double reach = 0;                  ///< m, from a seam, along a row in the flat pattern
  double lowest = 0, highest = 0;    ///< m, heights on the body, inclusive
};

/// The rows of a panel next to its top boundary, which hold the garment on the body.
struct Waistband {
  double height = 0;            ///< m; 0: no waistband
  double stiffness_factor = 8;  ///< of the structural springs along its rows
  double mass_factor = 4;       ///< of its nodes: keeps the largest stable time step about the same
  double seam_factor = 4;       ///< of the seams' force on its nodes (Joint::strength)
};

/// The cloth of a panel. The defaults are denim, light enough for a garment to settle quickly.
struct PanelMaterial {
  double area_density = 0.40;  ///< kg/m^2
  SpringMaterial structural{200, 0};
  SpringMaterial shear{60, 0};
  SpringMaterial bending{8, 0};
  /// Least mass of a node as a fraction of the panel's mean. At 0 the masses sum to the panel's; nodes on the
  /// boundary then have a half or a quarter of the mass, which shortens the largest stable time step. At 1
  /// they have the mass of the others: hems and seams are several layers of cloth.
  double least_mass_share = 0;
  Waistband waistband{};
};

/// The number of rows of the waistband, from the top: those that end within its height of the top corners
/// (mean of left and right), and the top row in any case. 0 without a waistband.
std::uint32_t waistband_rows(const PanelMesh& mesh, const Waistband& waistband);

/// Throws InputError, which names the panel, field and remedy, unless all values are finite, area density,
/// structural stiffness and factors are positive, and the others are not negative.
void require_cloth(const std::string& panel, const PanelMaterial& cloth);

/// Appends the springs of the 12-neighbour stencil in the order of springs_of(GridPatch); the rest length of
/// each is the distance of its ends in the pattern. Appends to `materials` those of the panel: structural,
/// shear, bending and, with a waistband, the structural one of its rows.
void append_springs(const GarmentPanel& panel, const PanelMesh& mesh, const PanelMaterial& cloth,
                    std::vector<Spring>& springs, std::vector<SpringMaterial>& materials);

/// kg, of each node: a quarter of the area of each of its cells times density, with the cloth's factors.
std::vector<double> node_masses(const PanelMesh& mesh, const PanelMaterial& cloth);

/// m^2, of all cells
double area_of(const PanelMesh& mesh);

/// z of the body's foremost and hindmost point at a height y, m. The functions are valid for every height
/// that a panel reaches.
struct BodyDepth {
  std::function<double(double)> front, back;
};

/// Where a panel starts: in front of or behind the body, bent around a vertical cylinder, at the heights at
/// which it is drawn.
struct PanelPlacement {
  bool behind = false;
  /// m, x of the pattern's x = 0, by height; its sign is the side of the body
  std::function<double(double)> axis = [](double) { return 0.0; };
  double distance = 0.03;  ///< m, from the body's foremost (hindmost) point at that height
  double radius = 0.105;   ///< m, of the bend
};

/// The nodes of a panel in space, m, rounded to micrometres. Its outside faces away from the body. The half
/// towards the plane x = 0 bends back by at most two thirds of the distance and then runs straight, so that
/// it stays clear of the trunk and the other leg. Throws InputError, which starts with `panel`, if the body
/// has no finite depth, and for a distance or radius that is not positive.
std::vector<Vec3d> place_panel(const std::string& panel, const PanelMesh& mesh,
                               const PanelPlacement& placement, const BodyDepth& body);

/// A part of a panel's boundary; from > to reverses its direction.
struct SeamStretch {
  std::string panel;
  PanelEdge edge = PanelEdge::left;
  double from = 0;  ///< fraction of the boundary's arc length
  double to = 1;
};

/// Two stretches that are sewn together, start to start.
struct Seam {
  std::string name;
  SeamStretch first, second;
  /// Largest difference of their lengths, as a fraction of the longer one, which is eased in.
  double tolerance = 0.03;
  std::string where{};  ///< its place in a scene file, a JSON pointer; empty if no user drew it
};

/// The joints of a seam (Vassilev, "Cloth simulation"). They join each node of the stretch with more nodes
/// (`first` if both have equally many) to the point at the same fraction of the other's length. At both ends,
/// and if a node is within a twentieth of the edge, that point is a node. A stretch runs between the nodes
/// nearest to its ends. The lengths of the joints sum to the length of the finer stretch.
///
/// `meshes` are those of `panels`; `seam_index` becomes Joint::seam. Throws InputError, which starts with
/// "seam NAME", for an unknown panel, a stretch outside its boundary or with fewer than two nodes, a stretch
/// that is sewn to itself, and lengths that differ by more than the tolerance.
std::vector<Joint> join_seam(const Seam& seam, std::span<const GarmentPanel> panels,
                             std::span<const PanelMesh> meshes, std::uint32_t seam_index);

/// A pattern piece with grid, cloth, placement and layer.
struct PatternPanel {
  PatternPiece piece;
  PanelGrid grid{};
  PanelMaterial cloth{};
  PanelPlacement placement{};
  std::uint32_t layer = 0;
  std::string where{};  ///< as Seam::where
};

/// The pattern of a garment.
struct GarmentPattern {
  std::vector<PatternPanel> panels;
  std::vector<Seam> seams;
  CloseSeams close = {};
  std::vector<std::uint32_t> crotch = {};  ///< indices of the seams of jeans that meet at the crotch
};

/// Thrown for an unusable panel or seam of a pattern. what() starts with its name.
struct PatternError : InputError {
  PatternError(const InputError& error, std::string where_)
      : InputError(error),
        where(std::move(where_)),
        folded(dynamic_cast<const FoldedPiece*>(&error) != nullptr) {}

  std::string where;  ///< of the panel or seam
  bool folded;        ///< the error was a FoldedPiece
};

/// Cuts, sews and places a pattern: a system at rest, its nodes and springs panel by panel, whose topology is
/// a Garment. The body, the settings of the dressing and all laws but those of springs are the scene's to
/// add. Throws PatternError for the errors of mesh_panel, require_cloth, join_seam and place_panel, and for
/// two panels of one name.
System build_garment(const GarmentPattern& pattern, const BodyDepth& body);

}  // namespace mssim
