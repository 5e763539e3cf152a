#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "garment/pattern/curve.h"
#include "text/error.h"

namespace mssim {

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

/// A grid line that must end at given places: a row on the left and right boundary, or a column on the bottom
/// and top one.
struct GridLine {
  std::uint32_t index = 0;  ///< of the row or column, neither the first nor the last
  double first = 0;         ///< fraction of the left (bottom) boundary's arc length
  double second = 0;        ///< fraction of the right (top) boundary's
};

/// How a piece is cut into cells. Between the lines that are given the others are spread evenly.
struct PanelGrid {
  std::uint32_t rows = 0;  ///< of nodes
  std::uint32_t columns = 0;
  std::vector<GridLine> row_lines{};     ///< ascending
  std::vector<GridLine> column_lines{};  ///< ascending
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

}  // namespace mssim
