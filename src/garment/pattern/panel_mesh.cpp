#include <algorithm>

#include "garment/pattern/garment_build.h"
#include "geometry/geometry.h"
#include "text/text.h"

namespace mssim {
namespace {

/// m
constexpr double corner_tolerance = 1e-4;

/// A straight piece of the outline.
struct Segment {
  Vec3d from, to;
  PanelEdge edge;
  std::size_t number;  ///< index along the outline
  double lowest() const { return std::min(from.y, to.y); }
  double highest() const { return std::max(from.y, to.y); }
};

void require_corner(const PatternPiece& piece, std::string_view corner, const Vec3d& a,
                    std::string_view edge_a, const Vec3d& b, std::string_view edge_b) {
  if (length(a - b) <= corner_tolerance) return;
  throw InputError(
      "{}: at the {} corner the {} boundary ends at {} and the {} one at {}; make them meet within 0.1 mm",
      piece.name, corner, edge_a, place(a), edge_b, place(b));
}

/// The outline, counter-clockwise. At corners, where curves meet only approximately, it uses one curve's
/// point; otherwise the gap would look like a crossing.
std::vector<Segment> outline_of(const PatternPiece& piece) {
  std::vector<Segment> outline;
  const auto add = [&](PanelEdge edge, auto begin, auto end) {
    for (auto point = begin; point + 1 != end; ++point) outline.push_back({*point, {}, edge, outline.size()});
  };
  const auto &lower = piece.bottom.points(), &upper = piece.top.points();
  const auto &to_left = piece.left.points(), &to_right = piece.right.points();
  add(PanelEdge::bottom, lower.begin(), lower.end());
  add(PanelEdge::right, to_right.begin(), to_right.end());
  add(PanelEdge::top, upper.rbegin(), upper.rend());
  add(PanelEdge::left, to_left.rbegin(), to_left.rend());
  for (Segment& segment : outline) segment.to = outline[(segment.number + 1) % outline.size()].from;
  return outline;
}

/// Whether both have a common point; if they are collinear, their boxes decide.
bool intersect(const Segment& a, const Segment& b) {
  const auto apart = [](double a1, double a2, double b1, double b2) {
    return std::max(a1, a2) < std::min(b1, b2) || std::max(b1, b2) < std::min(a1, a2);
  };
  const auto one_side = [](double t1, double t2) { return (t1 > 0 && t2 > 0) || (t1 < 0 && t2 < 0); };
  if (apart(a.from.x, a.to.x, b.from.x, b.to.x) || apart(a.from.y, a.to.y, b.from.y, b.to.y)) return false;
  // Positive left of the line.
  const auto side = [](const Segment& of, const Vec3d& point) {
    return cross(of.to - of.from, point - of.from).z;
  };
  return !one_side(side(a, b.from), side(a, b.to)) && !one_side(side(b, a.from), side(b, a.to));
}

[[noreturn]] void refuse(const PatternPiece& piece, const Segment& a, const Segment& b) {
  const std::string name_a = name_of(a.edge), name_b = name_of(b.edge);
  const std::string who = a.edge == b.edge ? fmt::format("the {} boundary meets itself", name_a)
                                           : fmt::format("the {} and the {} boundary meet", name_a, name_b);
  throw FoldedPiece("{}: {} near {}; draw them so that they neither cross nor touch", piece.name, who,
                    place(rounded(0.5 * (a.from + a.to))));
}

/// Throws InputError, which names panel, place and remedy, unless the corners of the piece meet to 0.1 mm and
/// its boundaries neither cross nor touch each other or themselves elsewhere.
void require_simple_boundary(const PatternPiece& piece) {
  require_corner(piece, "bottom left", piece.bottom.first(), "bottom", piece.left.first(), "left");
  require_corner(piece, "bottom right", piece.bottom.last(), "bottom", piece.right.first(), "right");
  require_corner(piece, "top left", piece.top.first(), "top", piece.left.last(), "left");
  require_corner(piece, "top right", piece.top.last(), "top", piece.right.last(), "right");

  std::vector<Segment> outline = outline_of(piece);
  const std::size_t count = outline.size();
  // By height, so that each is compared only with those at the same height.
  std::ranges::sort(outline, {}, [](const Segment& s) { return std::pair(s.lowest(), s.number); });
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count && outline[j].lowest() <= outline[i].highest(); ++j) {
      const Segment &a = outline[i], &b = outline[j];
      const std::size_t apart = a.number < b.number ? b.number - a.number : a.number - b.number;
      if (apart == 1 || apart + 1 == count) continue;
      if (intersect(a, b)) refuse(piece, a, b);
    }
}

void require_lines(const PatternPiece& piece, std::uint32_t count, std::string_view what) {
  if (count < 2 || count > most_panel_lines)
    throw InputError("{}: a panel cannot have {} {} of nodes; give a number from 2 to {}", piece.name, count,
                     what, most_panel_lines);
}

/// The ends of the grid lines of one direction.
struct LineEnds {
  std::vector<double> first, second;  ///< fractions of the two boundaries' arc lengths
};

/// The ends of `count` lines: the given ones, and evenly spaced ones between them.
LineEnds line_ends(const PatternPiece& piece, std::uint32_t count, const std::vector<GridLine>& given) {
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
      throw InputError(
          "{}: row {} cannot end at the fractions {} and {} of its boundaries; give ascending indices from 1 "
          "to {} and ascending fractions between 0 and 1",
          piece.name, line.index, shown(line.first), shown(line.second), count - 2);
    go_on_to(line);
  }
  go_on_to({count - 1, 1, 1});
  return ends;
}

/// Throws FoldedPiece unless the triangles at the four corners of each cell have positive areas: then the
/// cell is convex and counter-clockwise.
void require_unfolded(const PatternPiece& piece, const PanelMesh& mesh) {
  for (std::size_t row = 0; row + 1 < mesh.rows; ++row)
    for (std::size_t column = 0; column + 1 < mesh.columns; ++column) {
      const std::array<Vec3d, 4> corner{
          mesh.nodes[mesh.node(row, column)], mesh.nodes[mesh.node(row, column + 1)],
          mesh.nodes[mesh.node(row + 1, column + 1)], mesh.nodes[mesh.node(row + 1, column)]};
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d &here = corner[i], &next = corner[(i + 1) % 4], &before = corner[(i + 3) % 4];
        if (cross(next - here, before - here).z <= 0)
          throw FoldedPiece(
              "{}: the cell in row {} and column {} folds over at {}; straighten the boundaries there or end "
              "the grid lines elsewhere",
              piece.name, row, column, place(here));
      }
    }
}

/// m, of the line ends on a boundary
std::vector<double> arcs_of(const Curve& boundary, const std::vector<double>& fractions) {
  return mapped<double>(fractions, [&](double fraction) { return fraction * boundary.length(); });
}

std::vector<Vec3d> points_at(const Curve& boundary, const std::vector<double>& fractions) {
  return mapped<Vec3d>(fractions, [&](double fraction) { return boundary.at(fraction); });
}

}  // namespace

Curve::Curve(std::vector<Vec3d> points) : points_(std::move(points)) {
  if (points_.size() < 2)
    throw InputError("a boundary curve has {}; give two or more points", pluralize(points_.size(), "point"));
  arcs_.reserve(points_.size());
  const auto point = [this](std::size_t i) {
    return fmt::format("point {} of a boundary curve, {},", i, place(points_[i]));
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!is_finite(points_[i]) || points_[i].z != 0)
      throw InputError(point(i) +
                       " does not lie in the plane of the pattern; give finite x and y, and z = 0");
    if (i > 0 && points_[i] == points_[i - 1])
      throw InputError(point(i) + " equals the point before it; remove one of them");
    arcs_.push_back(i == 0 ? 0 : arcs_.back() + mssim::length(points_[i] - points_[i - 1]));
  }
}

Curve Curve::bezier(std::span<const Vec3d> points) {
  if (points.size() < 4 || points.size() % 3 != 1)
    throw InputError("a chain of cubic Bezier segments has {}; give 4, 7, 10 or another 3 n + 1 points",
                     pluralize(points.size(), "point"));
  std::vector<Vec3d> polyline{points.front()};
  polyline.reserve(points.size() / 3 * chords + 1);
  for (std::size_t p = 0; p + 3 < points.size(); p += 3)
    for (std::size_t i = 1; i <= chords; ++i) {
      const double t = static_cast<double>(i) / chords, s = 1 - t;
      polyline.push_back((s * s * s) * points[p] + (3 * s * s * t) * points[p + 1] +
                         (3 * s * t * t) * points[p + 2] + (t * t * t) * points[p + 3]);
    }
  return Curve(std::move(polyline));
}

Vec3d Curve::at(double fraction) const {
  if (fraction <= 0) return first();
  if (fraction >= 1) return last();
  const double arc = fraction * length();
  const auto after = std::upper_bound(arcs_.begin() + 1, arcs_.end() - 1, arc);
  const auto i = static_cast<std::size_t>(after - arcs_.begin());
  const double t = (arc - arcs_[i - 1]) / (arcs_[i] - arcs_[i - 1]);
  return points_[i - 1] + t * (points_[i] - points_[i - 1]);
}

Curve Curve::followed_by(const Curve& next) const {
  std::vector<Vec3d> points = points_;
  points.insert(points.end(), next.points_.begin() + (next.first() == last() ? 1 : 0), next.points_.end());
  return Curve(std::move(points));
}

Curve Curve::mirrored() const {
  return Curve(mapped<Vec3d>(points_, [](const Vec3d& p) { return Vec3d{-p.x, p.y, p.z}; }));
}

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
  const LineEnds row_ends = line_ends(piece, grid.rows, grid.row_lines);
  const LineEnds column_ends = line_ends(piece, grid.columns, {});

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
