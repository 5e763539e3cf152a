#pragma once

#include <optional>
#include <string>
#include <vector>

#include "garment/body/trunk_and_legs.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"

namespace mssim {

/// The gap between the two legs of an upright body at a height.
struct LegGap {
  double height = 0;         ///< y
  double low = 0, high = 0;  ///< x
  PlanPoint right, left;     ///< middles of the boxes around the parts at lower and higher x
};

/// The gaps of the longest run of evenly spaced heights that have one, bottom up. The surface is upright in y
/// and need not be closed; lengths are in its unit.
std::vector<LegGap> leg_gaps(const Surface& body);

/// An x between the legs at the highest gap, and at as many consecutive gaps below it as possible.
double between_legs(const std::vector<LegGap>& gaps);

/// The measures that a pattern needs of a body, mannequin or scan: a closed surface, m, that is upright in y,
/// faces +z and has one leg on each side of the plane x = 0. It may consist of several closed parts that
/// overlap. Only its trunk and legs count (trunk_and_legs): an arm next to the hip does not make it wider.
/// Measures are of the exact section of the triangles with a horizontal plane, including triangles in the
/// plane.
class BodyProfile {
 public:
  /// `name` starts messages of errors. Throws InputError for a surface that is not closed (validate_surface).
  explicit BodyProfile(const Surface& surface, std::string name = "body");

  /// The part that is measured and that garments collide with.
  const TrunkAndLegs& trunk_and_legs() const { return body_; }
  double lowest() const { return slices_.lowest(); }    ///< y, m
  double highest() const { return slices_.highest(); }  ///< y, m

  /// Whether the section divides into two legs at the bottom.
  bool has_legs() const { return crotch_.has_value(); }
  /// The height, m, below which the section divides into two legs: the lowest point of the trunk's cut with
  /// the plane x = 0. Throws InputError for a surface without a left and a right leg below it.
  double crotch_height() const;

  // All of these throw InputError for a height y, m, without body.

  /// The perimeter of the section's convex hull, m, which a tape measures.
  double hull_girth(double y) const;
  /// The girth of one leg, m: of the section's part at x < 0 for a negative `side`, else at x > 0. Throws
  /// InputError if the section reaches x = 0, as above the crotch, and if there is no such leg.
  double leg_girth(double y, int side) const;
  /// The fraction of the hull's girth in front of the plane at z, m, which passes through the section.
  double front_share(double y, double z) const;
  /// The length of a tape, m, in the plane x = 0, from the front of the body at the height y down between the
  /// legs and up to the back at the same height; it bridges hollows. Throws InputError for a body without
  /// legs, and for a height below the crotch.
  double crotch_length(double y) const;
  /// Whether the legs do not touch at x = 0 where leg_middle(y, side) cuts them.
  bool legs_are_apart(double y) const;
  /// The middle of the box around the section of one leg, at x < 0 for a negative `side`, else at x > 0. For
  /// heights above the crotch or below the leg, it is that of the nearest section of the leg. Throws
  /// InputError unless legs_are_apart().
  PlanPoint leg_middle(double y, int side) const;
  /// The middle of the box around the section.
  PlanPoint middle(double y) const;
  /// The largest z of the section, m.
  double front(double y) const;
  /// The smallest z of the section, m.
  double back(double y) const;
  /// The largest |x| of the section, m.
  double half_width(double y) const;

 private:
  /// The corners of the section's outline, in no order.
  std::vector<PlanPoint> section(double y) const;
  /// Its part on one side of x = 0.
  std::vector<PlanPoint> leg_section(double y, int side) const;
  /// The nearest height at which there is this leg, m.
  double within_leg(double y, int side) const;
  /// The height of the lowest point on one side of x = 0, m; infinite without points there.
  double lowest_point(int side) const;
  /// The union of `intervals`, in pieces, bottom up.
  static std::vector<HeightRange> merged(std::vector<HeightRange> intervals);
  std::vector<HeightRange> heights_in_the_middle() const;
  std::optional<double> find_crotch() const;

  std::string name_;
  TrunkAndLegs body_;
  HeightSlices slices_;
  std::vector<HeightRange> middle_;  ///< heights at which the section reaches x = 0
  double right_foot_, left_foot_;    ///< m, lowest_point() at x < 0 and at x > 0
  std::optional<double> crotch_;
};

/// A height of a body, and the girth there.
struct Landmark {
  double height = 0;            ///< m, above y = 0
  std::optional<double> girth;  ///< m, around the trunk or the thicker leg; none if legs are not apart
  bool by_proportion = false;   ///< not found on the body: a fraction of the crotch's height
};

/// Measures of a body for trousers. ISO 8559-1 defines waist and knee by bones, which a surface does not
/// show: here, the body is narrowest there.
struct BodyLandmarks {
  Landmark waist;            ///< the smallest girth between hip and chest
  Landmark hip;              ///< the greatest girth between crotch and waist
  double crotch_height = 0;  ///< m, above y = 0
  Landmark thigh;            ///< just below the crotch
  Landmark knee;             ///< the smallest girth between calf and thigh
  Landmark ankle;            ///< the smallest girth between foot and calf
};

/// Finds the landmarks of a body on y = 0. Throws InputError for a body without legs (BodyProfile).
BodyLandmarks find_landmarks(const BodyProfile& profile);

/// The girth of the thicker leg at a height, m; none if the legs are not apart or one does not reach it.
std::optional<double> thicker_leg(const BodyProfile& profile, double y);

/// A body with its measures.
struct MeasuredBody {
  Surface surface;      ///< the whole body, m, for pictures
  std::string note;     ///< a sentence about reading its file, or empty
  BodyProfile profile;  ///< of trunk and legs
};

}  // namespace mssim
