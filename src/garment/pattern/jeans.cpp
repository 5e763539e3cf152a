#include "garment/pattern/jeans.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

double inner_length(const JeansOutline& outline) { return outline.inseam.length() + outline.centre.length(); }

/// The mean height of an outline's rows, m, over and under the crotch point's row.
double mean_height(const JeansOutline& outline) {
  return 0.5 * (inner_length(outline) + outline.outer.length());
}

/// m^2, enclosed by the outline (Gauss's formula)
double area_of(const JeansOutline& outline) {
  double twice = 0;
  const auto add = [&](const Curve& curve, double sign) {
    for (std::size_t i = 1; i < curve.points().size(); ++i)
      twice += sign * cross(curve.points()[i - 1], curve.points()[i]).z;
  };
  add(outline.hem, 1);
  add(outline.inseam, 1);
  add(outline.centre, 1);
  add(outline.waist, -1);
  add(outline.outer, -1);
  return 0.5 * twice;
}

/// The fraction of the side seam that faces the crotch point. It lies lower than the point, so that cells
/// under the crotch curve, which is nearly level there, are less oblique.
double facing_fraction(const JeansOutline& outline) {
  constexpr double lower = 0.06;  // m
  const double height = outline.inseam.last().y - lower;
  double least = 0, most = 1;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (least + most);
    (outline.outer.at(middle).y < height ? least : most) = middle;
  }
  return rounded({most, 0, 0}).x;
}

double crotch_fraction(const JeansOutline& outline) {
  return outline.inseam.length() / inner_length(outline);
}

/// As drawn, with the outer side at the left, or mirrored.
PatternPiece piece_of(const std::string& name, const JeansOutline& outline, bool mirror) {
  const Curve inner = outline.inseam.followed_by(outline.centre);
  if (!mirror) return {name, outline.hem, outline.waist, outline.outer, inner};
  const auto turned = [](const Curve& curve) {
    std::vector<Vec3d> points = curve.mirrored().points();
    std::reverse(points.begin(), points.end());
    return Curve(std::move(points));
  };
  return {name, turned(outline.hem), turned(outline.waist), inner.mirrored(), outline.outer.mirrored()};
}

}  // namespace

JeansGrid jeans_grid(const JeansDraft& draft, std::uint32_t nodes) {
  if (nodes < 300 || nodes > 10'000'000)
    throw InputError("jeans: they cannot have " + std::to_string(nodes) +
                     " nodes; give a number from 300 to 10000000");
  const double height = 0.5 * (mean_height(draft.front) + mean_height(draft.back));
  const double front_width = area_of(draft.front) / height, back_width = area_of(draft.back) / height;
  const double inner_share = 0.5 * (crotch_fraction(draft.front) + facing_fraction(draft.front));
  JeansGrid best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t front = 2; front < 3'000; ++front) {
    const double cell = front_width / (front - 1);
    const auto back = static_cast<std::uint32_t>(std::lround(back_width / cell)) + 1;
    const double rows_wanted = static_cast<double>(nodes) / (2.0 * (front + back));
    const auto rows = static_cast<std::uint32_t>(std::lround(rows_wanted));
    if (rows < 4) break;
    const double shape = std::log(height / (rows - 1) / cell);
    const double excess = static_cast<double>(2 * rows * (front + back)) / nodes - 1;
    // A cell 10 % off a square weighs as much as 1 % of the nodes.
    const double cost = shape * shape + 100 * excess * excess;
    if (std::abs(excess) > 0.03 || cost >= least) continue;
    least = cost;
    best = {rows, static_cast<std::uint32_t>(std::lround(inner_share * (rows - 1))), front, back};
  }
  best.crotch_row = std::clamp(best.crotch_row, 1U, best.rows - 2);
  return best;
}

GarmentPattern jeans_pattern(const JeansMeasures& measures, std::uint32_t nodes, const PanelMaterial& cloth,
                             const LegAxis& leg_axis) {
  const JeansDraft draft = draft_jeans(measures);
  const JeansGrid grid = jeans_grid(draft, nodes);
  const double facing = facing_fraction(draft.front);
  GarmentPattern pattern;
  for (const bool is_left : {true, false})
    for (const bool behind : {false, true}) {
      const std::string name = std::string(behind ? "back " : "front ") + (is_left ? "left" : "right");
      const JeansOutline& outline = behind ? draft.back : draft.front;
      // Seen from outside, the wearer's left leg has its outer side at the right in front and at the left
      // behind.
      const bool mirror = is_left != behind;
      const double inner = crotch_fraction(outline);
      const GridLine crotch =
          mirror ? GridLine{grid.crotch_row, inner, facing} : GridLine{grid.crotch_row, facing, inner};
      PanelPlacement placement;
      placement.behind = behind;
      placement.axis = [leg_axis, is_left](double y) { return is_left ? leg_axis(y) : -leg_axis(y); };
      placement.radius = behind ? 0.13 : 0.105;
      const PanelGrid cells{grid.rows, behind ? grid.back_columns : grid.front_columns, {crotch}, {}};
      pattern.panels.push_back({piece_of(name, outline, mirror), cells, cloth, placement, 0});
    }
  const double front_crotch = crotch_fraction(draft.front), back_crotch = crotch_fraction(draft.back);
  constexpr PanelEdge at_left = PanelEdge::left, at_right = PanelEdge::right;
  pattern.seams = {
      {"outer left", {"front left", at_right, 0, 1}, {"back left", at_left, 0, 1}},
      {"outer right", {"front right", at_left, 0, 1}, {"back right", at_right, 0, 1}},
      {"inner left", {"front left", at_left, 0, front_crotch}, {"back left", at_right, 0, back_crotch}},
      {"inner right", {"front right", at_right, 0, front_crotch}, {"back right", at_left, 0, back_crotch}},
      {"centre front", {"front left", at_left, front_crotch, 1}, {"front right", at_right, front_crotch, 1}},
      {"centre back", {"back left", at_right, back_crotch, 1}, {"back right", at_left, back_crotch, 1}},
  };
  // The landmark of the thigh is just below the crotch.
  constexpr double below_the_crotch = 0.01, beside_the_seam = 0.05;  // m
  pattern.close = {{"outer left", "outer right"},
                   beside_the_seam,
                   measures.crotch_height - below_the_crotch,
                   measures.hip_height};
  return pattern;
}

}  // namespace mssim
