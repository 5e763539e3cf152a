#include "garment/pattern/panel_mesh.h"

#include "garment/pattern/boundary_check.h"
#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

constexpr std::uint32_t most_lines = 10'000;

void require_lines(const PatternPiece& piece, std::uint32_t count, std::string_view what) {
  if (count < 2 || count > most_lines)
    throw InputError(piece.name + ": it cannot have " + std::to_string(count) + " " + std::string(what) +
                     " of nodes; give a number from 2 to " + std::to_string(most_lines));
}

/// Where the grid lines of one direction end.
struct LineEnds {
  std::vector<double> first, second;  ///< fractions of the two boundaries' arc lengths
};

/// Lines `count` in number, through those that are given and evenly between them.
LineEnds line_ends(const PatternPiece& piece, std::string_view what, std::uint32_t count,
                   const std::vector<GridLine>& given) {
  LineEnds ends{{0}, {0}};
  GridLine last{};
  const auto go_on_to = [&](const GridLine& next) {
    for (std::uint32_t i = last.index + 1; i <= next.index; ++i) {
      const double fraction = static_cast<double>(i - last.index) / (next.index - last.index);
      ends.first.push_back(last.first + fraction * (next.first - last.first));
      ends.second.push_back(last.second + fraction * (next.second - last.second));
    }
    last = next;
  };
  for (const GridLine& line : given) {
    if (!(line.index > last.index && line.index + 1 < count && line.first > last.first && line.first < 1 &&
          line.second > last.second && line.second < 1))
      throw InputError(piece.name + ": " + std::string(what) + " " + std::to_string(line.index) +
                       " cannot end at the fractions " + shown(line.first) + " and " + shown(line.second) +
                       " of its boundaries; give ascending indices from 1 to " + std::to_string(count - 2) +
                       " and ascending fractions between 0 and 1");
    go_on_to(line);
  }
  go_on_to({count - 1, 1, 1});
  return ends;
}

/// The four areas (twice) of the triangles at the corners of a cell must be positive: it is convex then and
/// lies the right way round.
void require_unfolded(const PatternPiece& piece, const PanelMesh& mesh) {
  for (std::size_t row = 0; row + 1 < mesh.rows; ++row)
    for (std::size_t column = 0; column + 1 < mesh.columns; ++column) {
      const std::array<Vec3d, 4> corner{
          mesh.nodes[mesh.node(row, column)], mesh.nodes[mesh.node(row, column + 1)],
          mesh.nodes[mesh.node(row + 1, column + 1)], mesh.nodes[mesh.node(row + 1, column)]};
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d &here = corner[i], &next = corner[(i + 1) % 4], &before = corner[(i + 3) % 4];
        if (cross(next - here, before - here).z <= 0)
          throw FoldedPiece(piece.name + ": the cell of row " + std::to_string(row) + " and column " +
                            std::to_string(column) + " folds over at " + place(here) +
                            "; straighten the boundaries there or end the grid lines elsewhere");
      }
    }
}

/// m, of the line ends on a boundary
std::vector<double> arcs_of(const Curve& boundary, const std::vector<double>& fractions) {
  std::vector<double> arcs;
  arcs.reserve(fractions.size());
  for (const double fraction : fractions) arcs.push_back(fraction * boundary.length());
  return arcs;
}

std::vector<Vec3d> points_at(const Curve& boundary, const std::vector<double>& fractions) {
  std::vector<Vec3d> points;
  points.reserve(fractions.size());
  for (const double fraction : fractions) points.push_back(boundary.at(fraction));
  return points;
}

}  // namespace

std::vector<std::size_t> PanelMesh::edge_nodes(PanelEdge edge) const {
  const bool is_row = edge == PanelEdge::bottom || edge == PanelEdge::top;
  std::vector<std::size_t> on_edge;
  for (std::size_t i = 0; i < (is_row ? columns : rows); ++i)
    on_edge.push_back(is_row ? node(edge == PanelEdge::top ? rows - 1 : 0, i)
                             : node(i, edge == PanelEdge::right ? columns - 1 : 0));
  return on_edge;
}

PanelMesh mesh_panel(const PatternPiece& piece, const PanelGrid& grid) {
  require_lines(piece, grid.rows, "rows");
  require_lines(piece, grid.columns, "columns");
  require_simple_boundary(piece);
  const LineEnds row_ends = line_ends(piece, "row", grid.rows, grid.row_lines);
  const LineEnds column_ends = line_ends(piece, "column", grid.columns, grid.column_lines);

  PanelMesh mesh{grid.rows,
                 grid.columns,
                 {},
                 {arcs_of(piece.bottom, column_ends.first), arcs_of(piece.top, column_ends.second),
                  arcs_of(piece.left, row_ends.first), arcs_of(piece.right, row_ends.second)}};

  const std::vector<Vec3d> lower = points_at(piece.bottom, column_ends.first);
  const std::vector<Vec3d> upper = points_at(piece.top, column_ends.second);
  const std::vector<Vec3d> to_left = points_at(piece.left, row_ends.first);
  const std::vector<Vec3d> to_right = points_at(piece.right, row_ends.second);
  mesh.nodes.reserve(std::size_t{grid.rows} * grid.columns);
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double u = 0.5 * (column_ends.first[column] + column_ends.second[column]);
      const double v = 0.5 * (row_ends.first[row] + row_ends.second[row]);
      const Vec3d across = (1 - u) * to_left[row] + u * to_right[row];
      const Vec3d along = (1 - v) * lower[column] + v * upper[column];
      const Vec3d corners = (1 - v) * ((1 - u) * lower.front() + u * lower.back()) +
                            v * ((1 - u) * upper.front() + u * upper.back());
      mesh.nodes.push_back(rounded(across + along - corners));
    }
  require_unfolded(piece, mesh);
  return mesh;
}

}  // namespace mssim
