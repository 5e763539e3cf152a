#include "garment/pattern/boundary_check.h"

#include <algorithm>

#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

/// m
constexpr double corner_tolerance = 1e-4;

/// A straight piece of the outline.
struct Segment {
  Vec3d from, to;
  PanelEdge edge;
  std::size_t number;  ///< counted round the outline
  double lowest() const { return std::min(from.y, to.y); }
  double highest() const { return std::max(from.y, to.y); }
};

void require_corner(const PatternPiece& piece, std::string_view corner, const Vec3d& a,
                    std::string_view edge_a, const Vec3d& b, std::string_view edge_b) {
  if (length(a - b) <= corner_tolerance) return;
  throw InputError(piece.name + ": at the " + std::string(corner) + " corner the " + std::string(edge_a) +
                   " boundary ends at " + place(a) + " and the " + std::string(edge_b) + " one at " +
                   place(b) + "; make them meet within 0.1 mm");
}

/// The outline, counter-clockwise. At the corners, where the curves meet only nearly, it takes the first
/// one's point, or the gap would look like a crossing.
std::vector<Segment> outline_of(const PatternPiece& piece) {
  std::vector<Vec3d> points;
  std::vector<PanelEdge> edges;
  const auto add = [&](PanelEdge edge, auto begin, auto end) {
    for (auto point = begin; point + 1 != end; ++point) {
      points.push_back(*point);
      edges.push_back(edge);
    }
  };
  const auto &lower = piece.bottom.points(), &upper = piece.top.points();
  const auto &to_left = piece.left.points(), &to_right = piece.right.points();
  add(PanelEdge::bottom, lower.begin(), lower.end());
  add(PanelEdge::right, to_right.begin(), to_right.end());
  add(PanelEdge::top, upper.rbegin(), upper.rend());
  add(PanelEdge::left, to_left.rbegin(), to_left.rend());
  std::vector<Segment> outline;
  outline.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    outline.push_back({points[i], points[(i + 1) % points.size()], edges[i], i});
  return outline;
}

/// Twice the area of the triangle; positive where it goes round counter-clockwise.
double turn(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Is there a point common to both? On one line, their boxes decide.
bool intersect(const Segment& a, const Segment& b) {
  const auto apart = [](double a1, double a2, double b1, double b2) {
    return std::max(a1, a2) < std::min(b1, b2) || std::max(b1, b2) < std::min(a1, a2);
  };
  const auto one_side = [](double t1, double t2) { return (t1 > 0 && t2 > 0) || (t1 < 0 && t2 < 0); };
  if (apart(a.from.x, a.to.x, b.from.x, b.to.x) || apart(a.from.y, a.to.y, b.from.y, b.to.y)) return false;
  return !one_side(turn(a.from, a.to, b.from), turn(a.from, a.to, b.to)) &&
         !one_side(turn(b.from, b.to, a.from), turn(b.from, b.to, a.to));
}

[[noreturn]] void refuse(const PatternPiece& piece, const Segment& a, const Segment& b) {
  const std::string name_a = name_of(a.edge), name_b = name_of(b.edge);
  const std::string who = a.edge == b.edge ? "the " + name_a + " boundary meets itself"
                                           : "the " + name_a + " and the " + name_b + " boundary meet";
  throw FoldedPiece(piece.name + ": " + who + " near " + place(rounded(0.5 * (a.from + a.to))) +
                    "; draw them so that they neither cross nor touch");
}

}  // namespace

void require_simple_boundary(const PatternPiece& piece) {
  require_corner(piece, "bottom left", piece.bottom.first(), "bottom", piece.left.first(), "left");
  require_corner(piece, "bottom right", piece.bottom.last(), "bottom", piece.right.first(), "right");
  require_corner(piece, "top left", piece.top.first(), "top", piece.left.last(), "left");
  require_corner(piece, "top right", piece.top.last(), "top", piece.right.last(), "right");

  std::vector<Segment> outline = outline_of(piece);
  const std::size_t count = outline.size();
  // By height, so that each is compared with those beside it alone.
  std::sort(outline.begin(), outline.end(), [](const Segment& a, const Segment& b) {
    return a.lowest() != b.lowest() ? a.lowest() < b.lowest() : a.number < b.number;
  });
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count && outline[j].lowest() <= outline[i].highest(); ++j) {
      const Segment &a = outline[i], &b = outline[j];
      const std::size_t apart = a.number < b.number ? b.number - a.number : a.number - b.number;
      if (apart == 1 || apart + 1 == count) continue;
      if (intersect(a, b)) refuse(piece, a, b);
    }
}

}  // namespace mssim
