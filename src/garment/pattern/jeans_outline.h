#pragma once

#include <functional>

#include "garment/pattern/curve.h"

namespace mssim {

/// What jeans are drafted from, m. Heights are above the floor, on the standing body; "all round" is one
/// leg's circumference or the whole waist's.
struct JeansMeasures {
  /// The body's girth at a height between hip and waist (of the convex hull: a tape measure bridges hollows).
  std::function<double(double)> girth;
  /// The share of it before the side seams; none: half of it.
  std::function<double(double)> front_share{};
  /// The body's length from the front at a height through the crotch to the back
  /// (BodyProfile::crotch_length); none: the crotch curves are as long as the girth of the hip has them.
  std::function<double(double)> crotch_length{};
  double waist_height = 1.005;   ///< of the jeans' upper edge at the side
  double hip_height = 0.86;      ///< where the girth is largest
  double crotch_height = 0.768;  ///< of the body
  double knee_height = 0.47;
  double hem_height = 0.07;
  double knee = 0.42;          ///< of the jeans, all round one leg
  double hem = 0.36;           ///< of the jeans, all round one leg
  double hip_ease = 0;         ///< what the jeans are wider than 0.969 of the body, and offset, all round
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

}  // namespace mssim
