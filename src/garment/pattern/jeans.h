#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "garment/body/body_profile.h"
#include "garment/pattern/garment_build.h"

namespace mssim {

/// What jeans are drafted from, m. Heights are above the floor, on the standing body; "all round" is one
/// leg's circumference or the whole waist's.
struct JeansMeasures {
  /// The body's girth at a height between thigh and waist (of the convex hull: a tape measure bridges
  /// hollows).
  std::function<double(double)> girth;
  /// The share of it before the side seams; none: half of it.
  std::function<double(double)> front_share{};
  /// The body's length from the front at a height through the crotch to the back
  /// (BodyProfile::crotch_length); none: the crotch curves are as long as the girth of the hip has them.
  std::function<double(double)> crotch_length{};
  /// The hip that the body shows (BodyLandmarks::hip): the jeans are to lie close at the sides up to there,
  /// even where they are drafted with a lower one; none: up to the hip's height.
  std::optional<double> body_hip_height{};
  double waist_height = 1.005;   ///< of the jeans' upper edge at the side
  double hip_height = 0.86;      ///< where the girth is largest
  double crotch_height = 0.768;  ///< of the body
  double knee_height = 0.47;
  double hem_height = 0.07;
  double knee = 0.42;   ///< of the jeans, all round one leg
  double hem = 0.36;    ///< of the jeans, all round one leg
  double hip_ease = 0;  ///< what the jeans are wider than 0.969 of the body, and offset, all round
  /// What they are wider than 0.969 of both legs together, and offset, a centimetre below the crotch; none:
  /// the side seam goes from hip to knee whatever lies between.
  std::optional<double> thigh_ease{};
  double waist_ease = 0.01;    ///< what they are wider than 0.994 of the body, and offset
  double crotch_ease = 0.03;   ///< how far the crotch line lies below the body's
  double body_offset = 0.004;  ///< between body and cloth: both waist and hip grow by 2 pi of it
};

/// One leg's front or back as it is drawn: the outer side at the left, the inner one at the right, x = 0 in
/// the crease, y the height at which it is worn.
struct JeansOutline {
  Curve hem, waist;  ///< from the outer side to the inner one
  Curve outer;       ///< the side seam, from hem to waist, smooth from knee to waist
  Curve inseam;      ///< from the hem to the crotch point
  Curve centre;      ///< crotch curve and centre seam, from the crotch point to the waist
};

/// The outlines of front and back, whose inseams are equally long: the back's crotch point is lowered until
/// they are.
struct JeansDraft {
  JeansOutline front, back;
};

/// Throws InputError, which names the measure, its value and the remedy, for heights that are not in order
/// from hem to waist, lengths out of range, a girth that is no length, and measures whose inseams cannot be
/// made equal.
JeansDraft draft_jeans(const JeansMeasures& measures);

/// How many rows and columns the panels of jeans have. Front and back have the same rows, so that their seams
/// join node to node.
struct JeansGrid {
  std::uint32_t rows = 0;
  std::uint32_t crotch_row = 0;  ///< ends in the crotch point
  std::uint32_t front_columns = 0;
  std::uint32_t back_columns = 0;
};

/// Cells about square, and the number of nodes within 3 % of the wanted one. Throws InputError for less than
/// 300 or more than 10 million nodes.
JeansGrid jeans_grid(const JeansDraft& draft, std::uint32_t nodes);

/// Jeans of four panels ("front left", "back left", "front right", "back right", by the wearer's sides) and
/// six seams ("outer left", "outer right", "inner left", "inner right", "centre front", "centre back"), of
/// `cloth`, with about as many nodes as wanted. The wearer looks to +z, its left is +x; `leg_axis` is x of
/// its left leg by height, m, positive. At the outer seams, and 5 cm beside them, they are to lie close to
/// the body, from the thigh (1 cm below the crotch) up to the hip that the body shows, and to the jeans' own
/// at least. Throws InputError as draft_jeans and jeans_grid do.
GarmentPattern jeans_pattern(const JeansMeasures& measures, std::uint32_t nodes, const PanelMaterial& cloth,
                             const std::function<double(double)>& leg_axis);

/// Measures of jeans for a body, in whole millimetres, but for what the body itself says when they are
/// drafted (its girth, crotch and offset): worn as those of the reference body are, with their upper edge a
/// fifth of the way below the waist and legs that are wider than the body's at every height. They have an
/// ease at the thigh, and a larger one at the crotch.
JeansMeasures jeans_for_body(const BodyProfile& profile, const BodyLandmarks& body);

}  // namespace mssim
