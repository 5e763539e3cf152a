#include "garment/pattern/jeans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "geometry/geometry.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Differences between front and back. Proportions are those of textbook trouser drafts (Aldrich, "Metric
/// Pattern Cutting"); the lengths fitted best on the reference body.
struct Half {
  bool before;             ///< in front of the side seams
  double width;            ///< m, added to half of the body's front or back part of each girth
  double fork_share;       ///< of the hip's girth: length of the fork, from centre line to crotch point ...
  double fork_more;        ///< m, ... plus this
  double centre_share;     ///< of the difference of hip and waist, removed at the centre
  double raised;           ///< m, of the waist at the centre over waist_height
  double crease_outwards;  ///< m, from the middle of the widest line
  double curve_height;     ///< m, over the crotch line, at which the crotch curve meets the centre line
  double inseam_hollow;    ///< m, of the inseam's control point from the crotch point
  double fork_flatness;    ///< of the fork: length of the crotch curve's lower control
};
constexpr Half front_half{true, -0.007, 1.0 / 16, 0, 0.8, -0.009, 0, 0.075, 0.018, 0.60};
constexpr Half back_half{false, 0.007, 1.0 / 8, 0.005, 1.05, 0.010, 0.015, 0.09, 0.040, 0.62};

/// Stretch of jeans without ease, as a fraction of the body's girth, from thigh to hip and at the waist.
/// Around a body that curves in both directions, the cloth is too long at the side seams; without tension it
/// stands off there.
constexpr double hip_stretch = 0.031, waist_stretch = 0.006;

constexpr double thigh_below_crotch = 0.01;  // m, of the landmark of the thigh

constexpr double side_raised = -0.003;  // m, of the waist at the side
constexpr double side_slope = 0.2;      // of the waist's descent from there

Curve bezier(const Vec3d& from, const Vec3d& control_1, const Vec3d& control_2, const Vec3d& to) {
  return Curve::bezier(std::array{from, control_1, control_2, to});
}

/// Least-squares fit of a function of the height by a cubic with given values at two heights.
struct FittedCubic {
  double low_slope = 0, high_slope = 0;  ///< dx/dy at the two heights
};

FittedCubic fit_slopes(double low, double low_value, double high, double high_value,
                       const std::function<double(double)>& wanted) {
  constexpr int samples = 32;
  const double height = high - low;
  double a = 0, b = 0, c = 0, p = 0, q = 0;  // normal equations [a b; b c] slopes = [p; q]
  for (int i = 1; i < samples; ++i) {
    const double t = static_cast<double>(i) / samples, s = 1 - t;
    const double rest =
        wanted(low + t * height) - s * s * (1 + 2 * t) * low_value - t * t * (3 - 2 * t) * high_value;
    const double of_low = height * t * s * s, of_high = -height * t * t * s;
    a += of_low * of_low;
    b += of_low * of_high;
    c += of_high * of_high;
    p += of_low * rest;
    q += of_high * rest;
  }
  const double determinant = a * c - b * b;
  return {(c * p - b * q) / determinant, (a * q - b * p) / determinant};
}

/// Drafts one half, with x = 0 at the hip of the outer side.
class Drafting {
 public:
  Drafting(const JeansMeasures& measures, const Half& half, double fork_factor)
      : m_(measures),
        half_(half),
        crotch_line_(m_.crotch_height - m_.crotch_ease),
        hip_width_(width_at(m_.hip_height)),
        waist_width_(width_at(m_.waist_height)),
        fork_(fork_factor * (half.fork_share * m_.girth(m_.hip_height) + half.fork_more)),
        crease_(0.5 * (hip_width_ + fork_) - half.crease_outwards) {}

  /// The outline with the crotch point `drop` below the crotch line, m.
  JeansOutline outline(double drop) const {
    const Vec3d waist_centre{hip_width_ - centre_taken(), m_.waist_height + half_.raised, 0};
    const Curve waist_line = waist(waist_centre);
    const double half_knee = 0.25 * m_.knee + 0.5 * half_.width, half_hem = 0.25 * m_.hem + 0.5 * half_.width;
    const Vec3d outer_hem{crease_ - half_hem, m_.hem_height, 0},
        inner_hem{crease_ + half_hem, m_.hem_height, 0};
    const Vec3d outer_knee{crease_ - half_knee, m_.knee_height, 0};
    const Vec3d inner_knee{crease_ + half_knee, m_.knee_height, 0};
    const Vec3d crotch_point{hip_width_ + fork_, crotch_line_ - drop, 0};
    return {
        from_crease(Curve({outer_hem, inner_hem})), from_crease(waist_line),
        from_crease(
            Curve({outer_hem, outer_knee}).followed_by(side(outer_hem, outer_knee, waist_line.first()))),
        from_crease(Curve({inner_hem, inner_knee}).followed_by(thigh(inner_hem, inner_knee, crotch_point))),
        from_crease(centre(crotch_point, waist_centre))};
  }

 private:
  /// Width of this half of one leg at a height from hip to waist, m.
  double width_at(double y) const {
    const double fraction = (y - m_.hip_height) / (m_.waist_height - m_.hip_height);
    const double girth = girth_at(y);
    return quarter(y, girth,
                   (1 - fraction) * (m_.hip_ease - hip_stretch * girth) +
                       fraction * (m_.waist_ease - waist_stretch * girth));
  }

  double girth_at(double y) const {
    const double girth = m_.girth(y);
    if (!(girth > 0.2 && girth < 5))
      throw InputError("jeans: the body's girth at the height " + shown(y) + " m is " + shown(girth) +
                       " m; give a body with a girth from 0.2 to 5 m there");
    return girth;
  }

  /// Half of the front or back, m, of jeans with the circumference of girth, offset and ease. Front and back
  /// have the fractions of the body at the height y.
  double quarter(double y, double girth, double ease) const {
    const double front = m_.front_share ? m_.front_share(y) : 0.5;
    const double share = half_.before ? front : 1 - front;
    return 0.5 * share * (girth + 2 * std::numbers::pi * m_.body_offset + ease) + half_.width;
  }

  double centre_taken() const { return half_.centre_share * (hip_width_ - waist_width_); }

  /// The height at which the centre seam starts to lean to the side; the crotch curve ends there.
  double centre_bend() const { return crotch_line_ + half_.curve_height; }
  double centre_height() const { return m_.waist_height + half_.raised - centre_bend(); }

  /// x of the centre seam, extended below: vertical up to the bend, above it a cubic of the height that leans
  /// more with height, as the body does over seat and belly.
  double centre_x(double y) const {
    const double t = std::max(0.0, (y - centre_bend()) / centre_height());
    return hip_width_ - centre_taken() * t * t * (3 - top_lean + (top_lean - 2) * t);
  }
  /// -dx/dy of the centre seam at the waist.
  double centre_lean() const { return top_lean * centre_taken() / centre_height(); }

  /// The upper edge, with the length of the waist. It rises to the side, where front and back would otherwise
  /// form a notch, and is perpendicular to the centre seam.
  Curve waist(const Vec3d& at_centre) const {
    double width = waist_width_;
    const auto drawn = [&] {
      const Vec3d at_side{at_centre.x - width, m_.waist_height + side_raised, 0};
      return bezier(at_side, at_side + (width / 3) * Vec3d{1, -side_slope, 0},
                    at_centre - (width / 3) * Vec3d{1, centre_lean(), 0}, at_centre);
    };
    // The slope adds at most 2 % of length, so that each turn leaves 2 % of the error.
    for (int turn = 0; turn < 12; ++turn) width *= waist_width_ / drawn().length();
    return drawn();
  }

  /// The side seam from knee to waist: cubics with equal directions where they meet, at the hip and, if there
  /// is an ease at the thigh, there. The uppermost one follows the body's girth.
  Curve side(const Vec3d& hem, const Vec3d& knee, const Vec3d& at_waist) const {
    const auto wanted = [this](double y) { return centre_x(y) - width_at(y); };
    const Vec3d hip{wanted(m_.hip_height), m_.hip_height, 0};
    const double height = at_waist.y - hip.y, leg = hip.y - knee.y;
    const FittedCubic fit = fit_slopes(hip.y, hip.x, at_waist.y, at_waist.x, wanted);
    const Vec3d at_hip{fit.low_slope, 1, 0}, at_knee = along(hem, knee);
    std::vector<Vec3d> points{knee};
    if (m_.thigh_ease) {
      const double y = m_.crotch_height - thigh_below_crotch, girth = girth_at(y);
      // The legs have the hip's fractions of front and back.
      const double width = quarter(m_.hip_height, girth, *m_.thigh_ease - hip_stretch * girth);
      const Vec3d thigh{hip_width_ - width, y, 0};
      // The direction at the thigh is that of the parabola through knee, thigh and hip.
      const double below = y - knee.y, above = hip.y - y;
      const Vec3d at_thigh = 1 / leg * (above * along(knee, thigh) + below * along(thigh, hip));
      points.insert(points.end(), {knee + 0.31 * below * at_knee, thigh - below / 3 * at_thigh, thigh,
                                   thigh + above / 3 * at_thigh, hip - above / 3 * at_hip});
    } else {
      points.insert(points.end(), {knee + 0.31 * leg * at_knee, hip - 0.2 * leg * at_hip});
    }
    points.insert(points.end(), {hip, hip + height / 3 * at_hip,
                                 at_waist - height / 3 * Vec3d{fit.high_slope, 1, 0}, at_waist});
    return Curve::bezier(points);
  }

  Curve thigh(const Vec3d& hem, const Vec3d& knee, const Vec3d& crotch_point) const {
    const double height = crotch_point.y - knee.y;
    return bezier(knee, knee + 0.36 * height * along(hem, knee),
                  crotch_point - Vec3d{half_.inseam_hollow, 0.43 * height, 0}, crotch_point);
  }

  /// The crotch curve, nearly horizontal at the crotch point, and the seam of centre_x above it.
  Curve centre(const Vec3d& crotch_point, const Vec3d& at_waist) const {
    const Vec3d bend{hip_width_, centre_bend(), 0}, up{0, 1, 0};
    const double third = centre_height() / 3;
    return Curve::bezier(std::array{crotch_point,
                                    crotch_point - Vec3d{half_.fork_flatness * fork_, -0.002, 0},
                                    bend - 0.75 * half_.curve_height * up, bend, bend + third * up,
                                    at_waist - third * Vec3d{-centre_lean(), 1, 0}, at_waist});
  }

  /// The direction of the line between two points, with y = 1.
  static Vec3d along(const Vec3d& from, const Vec3d& to) { return 1 / (to.y - from.y) * (to - from); }

  Curve from_crease(const Curve& curve) const {
    return Curve(mapped<Vec3d>(curve.points(), [this](const Vec3d& point) {
      return point - Vec3d{crease_, 0, 0};
    }));
  }

  /// The centre seam's lean at the waist over its mean.
  static constexpr double top_lean = 1.2;

  const JeansMeasures& m_;
  const Half& half_;
  double crotch_line_;
  double hip_width_, waist_width_;
  double fork_;
  double crease_;  ///< x
};

void require_between(double value, double least, double most, const std::string& what) {
  if (!(value >= least && value <= most))
    throw InputError("jeans: {} is {} m; give a length from {} to {} m", what, shown(value), shown(least),
                     shown(most));
}

void require_measures(const JeansMeasures& m) {
  if (!m.girth) throw InputError("jeans: the body's girth is missing; give it as a function of the height");
  require_between(m.hem_height, 0, 2, "the hem's height, hem_height_m,");
  const double least = 0.03;  // between two of the heights
  require_between(m.knee_height, m.hem_height + least, 2,
                  "the knee's height, knee_height_m, which must be above the hem's,");
  require_between(
      m.crotch_height - m.crotch_ease, m.knee_height + least, 2,
      "the crotch line's height, the body's crotch less crotch_ease_m, which must be above the knee's, "
      "knee_height_m,");
  require_between(m.hip_height, m.crotch_height + least, 2,
                  "the hip's height, hip_height_m, which must be above the crotch's,");
  require_between(m.waist_height, m.hip_height + least, 2,
                  "the waist's height, waist_height_m, which must be above the hip's,");
  require_between(m.knee, 0.1, 2, "the jeans' circumference at the knee, knee_m,");
  require_between(m.hem, 0.1, 2, "the jeans' circumference at the hem, hem_m,");
  require_between(m.hip_ease, -0.2, 0.5, "the ease at the hip, hip_ease_m,");
  require_between(m.thigh_ease.value_or(0), -0.2, 0.5, "the ease at the thigh, thigh_ease_m,");
  if (m.thigh_ease)
    require_between(
        m.crotch_height - thigh_below_crotch, m.knee_height + least, 2,
        "the thigh's height, 1 cm below the body's crotch, which must be above the knee's, knee_height_m,");
  require_between(m.waist_ease, -0.2, 0.5, "the ease at the waist, waist_ease_m,");
  require_between(m.crotch_ease, -0.05, 0.2, "the ease at the crotch, crotch_ease_m,");
  require_between(m.body_offset, 0, 0.05, "the distance between body and cloth");
}

/// A draft whose forks have `fork_factor` times the length that follows from the hip's girth.
JeansDraft draft_with(const JeansMeasures& measures, double fork_factor) {
  const Drafting front(measures, front_half, fork_factor), back(measures, back_half, fork_factor);
  const JeansOutline front_outline = front.outline(0);
  const double inseam = front_outline.inseam.length();
  constexpr double least = -0.03, most = 0.08;  // m: the back's inseam shrinks over this range
  const auto back_inseam = [&](double drop) { return back.outline(drop).inseam.length(); };
  if (!(back_inseam(least) > inseam && back_inseam(most) < inseam))
    throw InputError(
        "jeans: no crotch point makes the back's inseam as long as the front's of " + shown(inseam) +
        " m; change the heights (hip_height_m, waist_height_m, knee_height_m, hem_height_m) or the "
        "circumferences (knee_m, hem_m) towards the body's");
  const auto is_long = [&](double drop) { return back_inseam(drop) > inseam; };
  return {front_outline, back.outline(bisected({least, most}, 30, is_long).fails)};
}

/// The factor of the forks' length for which the centre seams are as long as the body there plus some ease: a
/// body that is deep for its girth needs longer forks.
double fork_factor(const JeansMeasures& measures) {
  if (!measures.crotch_length) return 1;
  constexpr double ease = 0.05;  // m, including that of the crotch and the raised back
  const double wanted = measures.crotch_length(measures.waist_height) + ease;
  const auto [least, most] = bisected({0.7, 1.6}, 12, [&](double factor) {
    const JeansDraft draft = draft_with(measures, factor);
    return draft.front.centre.length() + draft.back.centre.length() < wanted;
  });
  return 0.5 * (least + most);
}

double inner_length(const JeansOutline& outline) { return outline.inseam.length() + outline.centre.length(); }

/// The mean length of an outline's inner and outer sides, m.
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

/// The fraction of the side seam opposite the crotch point. It is lower than the crotch point, so that cells
/// under the crotch curve, which is nearly horizontal there, are less oblique.
double facing_fraction(const JeansOutline& outline) {
  constexpr double lower = 0.06;  // m
  const double height = outline.inseam.last().y - lower;
  const auto is_lower = [&](double fraction) { return outline.outer.at(fraction).y < height; };
  return rounded({bisected({0, 1}, 40, is_lower).fails, 0, 0}).x;
}

double crotch_fraction(const JeansOutline& outline) {
  return outline.inseam.length() / inner_length(outline);
}

/// The piece as drawn, with the outer side on the left, or mirrored.
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

double in_millimetres(double metres) { return std::round(1000 * metres) / 1000; }

/// The ease of jeans at their upper edge, m. If the body hardly widens from there to the hip, they must be
/// narrower to hold.
double ease_at_waist(const BodyProfile& profile, const JeansMeasures& jeans) {
  constexpr double usual = 0.01, least = -0.015;  // m
  constexpr double steep = 0.7;                   // m of girth per m of height: `usual` above this
  constexpr double narrower = 0.1;                // m, less by this per m/m below `steep`
  const double widening = (profile.hull_girth(jeans.hip_height) - profile.hull_girth(jeans.waist_height)) /
                          (jeans.waist_height - jeans.hip_height);
  return std::clamp(usual + narrower * (widening - steep), least, usual);
}

/// By how much the trouser leg, straight from hem to knee, must be wider to go around the body's with some
/// air, m.
double lack_of_width(const BodyProfile& profile, const JeansMeasures& jeans) {
  constexpr double air = 0.03, step = 0.01;  // m
  double lack = 0;
  for (double y = jeans.hem_height; y <= jeans.knee_height; y += step) {
    const double fraction = (y - jeans.hem_height) / (jeans.knee_height - jeans.hem_height);
    const double width = (1 - fraction) * jeans.hem + fraction * jeans.knee;
    lack = std::max(lack, thicker_leg(profile, y).value_or(0) + air - width);
  }
  return lack;
}

}  // namespace

JeansDraft draft_jeans(const JeansMeasures& measures) {
  require_measures(measures);
  return draft_with(measures, fork_factor(measures));
}

JeansGrid jeans_grid(const JeansDraft& draft, std::uint32_t nodes) {
  if (nodes < 300 || nodes > 10'000'000)
    throw InputError("jeans: they cannot have {} nodes; give a number from 300 to 10000000", nodes);
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
    // A cell with sides that differ by 10 % costs as much as an error of 1 % of the nodes.
    const double cost = shape * shape + 100 * excess * excess;
    if (std::abs(excess) > 0.03 || cost >= least) continue;
    least = cost;
    best = {rows, static_cast<std::uint32_t>(std::lround(inner_share * (rows - 1))), front, back};
  }
  best.crotch_row = std::clamp(best.crotch_row, 1U, best.rows - 2);
  return best;
}

GarmentPattern jeans_pattern(const JeansMeasures& measures, std::uint32_t nodes, const PanelMaterial& cloth,
                             const std::function<double(double)>& leg_axis) {
  const JeansDraft draft = draft_jeans(measures);
  const JeansGrid grid = jeans_grid(draft, nodes);
  const double facing = facing_fraction(draft.front);
  GarmentPattern pattern;
  for (const bool is_left : {true, false})
    for (const bool behind : {false, true}) {
      const std::string name = std::string(behind ? "back " : "front ") + (is_left ? "left" : "right");
      const JeansOutline& outline = behind ? draft.back : draft.front;
      // Seen from outside, the outer side of the wearer's left leg is on the right in front and on the left
      // at the back.
      const bool mirror = is_left != behind;
      const double inner = crotch_fraction(outline);
      const GridLine crotch =
          mirror ? GridLine{grid.crotch_row, inner, facing} : GridLine{grid.crotch_row, facing, inner};
      PanelPlacement placement;
      placement.behind = behind;
      placement.axis = [leg_axis, is_left](double y) { return is_left ? leg_axis(y) : -leg_axis(y); };
      placement.radius = behind ? 0.13 : 0.105;
      const PanelGrid cells{grid.rows, behind ? grid.back_columns : grid.front_columns, {crotch}};
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
  constexpr double beside_the_seam = 0.05;  // m
  pattern.crotch = {2, 3, 4, 5};
  pattern.close = {{0, 1},
                   beside_the_seam,
                   measures.crotch_height - thigh_below_crotch,
                   std::max(measures.hip_height, measures.body_hip_height.value_or(0))};
  return pattern;
}

JeansMeasures jeans_for_body(const BodyProfile& profile, const BodyLandmarks& body) {
  constexpr double edge = 0.8;                              // of the way from the hip to the waist
  constexpr double wider_knee = 1.135, wider_hem = 1.5;     // factors to knee and ankle
  constexpr double usual_share = 0.62, thin_share = 0.575;  // girth of a thigh over that of the hip
  JeansMeasures jeans;
  jeans.waist_height = in_millimetres(body.hip.height + edge * (body.waist.height - body.hip.height));
  jeans.hip_height = in_millimetres(body.hip.height);
  jeans.crotch_height = body.crotch_height;
  // Chosen on the twenty persons of tests/support/persons.csv, all of whom fit; 17 did with the same ease at
  // the thigh (1 cm) and none at the hip for everybody. The thinner the thighs are for the hip, the more the
  // cloth narrows from one to the other, and stretches too much without ease. With ease it stands off full
  // thighs at the sides.
  const double hip = profile.hull_girth(body.hip.height);
  const double share = body.thigh.girth.value_or(usual_share * hip) / hip;
  const double thin = std::max(0.0, thin_share - share);
  jeans.crotch_ease = 0.037;
  jeans.thigh_ease =
      in_millimetres(std::clamp(0.008 + 0.6 * (usual_share - share), -0.013, 0.028) + 0.9 * thin);
  jeans.hip_ease = in_millimetres(0.35 * thin);
  jeans.knee_height = in_millimetres(body.knee.height);
  jeans.hem_height = in_millimetres(std::max(body.ankle.height - 0.02, 0.03));
  if (body.knee.girth) jeans.knee = wider_knee * *body.knee.girth;
  if (body.ankle.girth) jeans.hem = wider_hem * *body.ankle.girth;
  const double lack = lack_of_width(profile, jeans);
  jeans.waist_ease = in_millimetres(ease_at_waist(profile, jeans));
  jeans.knee = in_millimetres(jeans.knee + lack);
  jeans.hem = in_millimetres(jeans.hem + lack);
  return jeans;
}

}  // namespace mssim
