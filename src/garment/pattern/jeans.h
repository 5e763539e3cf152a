#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "garment/body/body_profile.h"
#include "garment/pattern/garment_build.h"

namespace mssim {

/// Measures from which jeans are drafted, m. Heights are above the floor, on the standing body. Eases are for
/// the whole circumference of waist or hip.
struct JeansMeasures {
  /// The body's girth (of the convex hull) at a height between thigh and waist.
  std::function<double(double)> girth;
  /// The fraction of it in front of the side seams; none: half.
  std::function<double(double)> front_share{};
  /// The body's length from the front at a height through the crotch to the back
  /// (BodyProfile::crotch_length); none: the length of the crotch curves follows from the girth of the hip.
  std::function<double(double)> crotch_length{};
  /// The height of the body's hip (BodyLandmarks::hip), up to which the jeans must lie close at the sides
  /// even if they are drafted with a lower one; none: hip_height.
  std::optional<double> body_hip_height{};
  double waist_height = 1.005;   ///< of the jeans' upper edge at the side
  double hip_height = 0.86;      ///< where the girth is largest
  double crotch_height = 0.768;  ///< of the body
  double knee_height = 0.47;
  double hem_height = 0.07;
  double knee = 0.42;   ///< circumference of a trouser leg
  double hem = 0.36;    ///< circumference of a trouser leg
  double hip_ease = 0;  ///< over 0.969 of the body's girth, and over the offset
  /// Ease 1 cm below the crotch, over 0.969 of the girth of both legs together and over the offset; none: the
  /// side seam runs from hip to knee without regard to the thigh.
  std::optional<double> thigh_ease{};
  double waist_ease = 0.01;    ///< over 0.994 of the body's girth, and over the offset
  double crotch_ease = 0.03;   ///< distance of the crotch line below the body's crotch
  double body_offset = 0.004;  ///< between body and cloth: both waist and hip grow by 2 pi of it
};

/// The front or back of one leg as drawn: outer side on the left, inner side on the right, x = 0 at the
/// crease, y the height when worn.
struct JeansOutline {
  Curve hem, waist;  ///< from the outer side to the inner side
  Curve outer;       ///< the side seam, from hem to waist, smooth from knee to waist
  Curve inseam;      ///< from the hem to the crotch point
  Curve centre;      ///< crotch curve and centre seam, from the crotch point to the waist
};

/// The outlines of front and back. The back's crotch point is lowered until both inseams are equally long.
struct JeansDraft {
  JeansOutline front, back;
};

/// Throws InputError, which names the measure, its value and the remedy, for heights that are not in order
/// from hem to waist, lengths and girths out of range, and measures whose inseams cannot be made equal.
JeansDraft draft_jeans(const JeansMeasures& measures);

/// The numbers of rows and columns of the panels of jeans. Front and back have equally many rows, so that
/// their seams join node to node.
struct JeansGrid {
  std::uint32_t rows = 0;
  std::uint32_t crotch_row = 0;  ///< ends in the crotch point
  std::uint32_t front_columns = 0;
  std::uint32_t back_columns = 0;
};

/// A grid with cells about square, and the number of nodes within 3 % of `nodes`. Throws InputError for fewer
/// than 300 or more than 10 million nodes.
JeansGrid jeans_grid(const JeansDraft& draft, std::uint32_t nodes);

/// Jeans of four panels ("front left", "back left", "front right", "back right", by the wearer's sides) and
/// six seams ("outer left", "outer right", "inner left", "inner right", "centre front", "centre back"), of
/// `cloth`, with about `nodes` nodes. The wearer faces +z, and its left is +x; `leg_axis` is x of its left
/// leg by height, m, positive. The cloth within 5 cm of the outer seams must lie close to the body, from the
/// thigh (1 cm below the crotch) up to the higher of the body's hip and the jeans'. Throws InputError as
/// draft_jeans and jeans_grid do.
GarmentPattern jeans_pattern(const JeansMeasures& measures, std::uint32_t nodes, const PanelMaterial& cloth,
                             const std::function<double(double)>& leg_axis);

/// Measures of jeans for a body, in whole millimetres; girth, crotch and offset of the body are measured
/// later, on drafting. The jeans are worn as on the reference body: their upper edge is a fifth of the way
/// from waist to hip below the waist, and their legs are wider than the body's at every height. The thinner
/// the thighs are for the hip, the larger are the eases at hip and thigh.
JeansMeasures jeans_for_body(const BodyProfile& profile, const BodyLandmarks& body);

}  // namespace mssim
