#pragma once

#include <optional>
#include <string>
#include <vector>

#include "garment/body/trunk_and_legs.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"

namespace mssim {

/// What is between the two legs of an upright body at a height: no point of its section.
struct LegGap {
  double height = 0;         ///< y
  double low = 0, high = 0;  ///< x
  PlanPoint right, left;  ///< the middles of the boxes around what lies on either side, at lower and higher x
};

/// The gaps at evenly spaced heights, from below upwards, of the longest run of heights that have one. The
/// surface, which stands upright in y, need not be closed; lengths are in its unit.
std::vector<LegGap> leg_gaps(const Surface& body);

/// The x that is between the legs at the highest gap, and at as many of those below as there is one.
double between_legs(const std::vector<LegGap>& gaps);

/// The measures that a pattern needs of a body, mannequin or scan: any closed surface, m, that stands upright
/// in y, looks to +z and has a leg on either side of the plane x = 0. It may be of several closed parts that
/// overlap. Only its trunk and legs count (trunk_and_legs): an arm beside the hip does not make it wider.
/// Measures are of the exact section of the triangles with a horizontal plane; a triangle that lies in the
/// plane belongs to it.
class BodyProfile {
 public:
  /// `name` begins what errors say. Throws InputError for a surface that is not closed (validate_surface).
  explicit BodyProfile(const Surface& surface, std::string name = "body");

  /// What is measured, and what garments meet.
  const TrunkAndLegs& trunk_and_legs() const { return body_; }
  double lowest() const { return slices_.lowest(); }    ///< y, m
  double highest() const { return slices_.highest(); }  ///< y, m

  /// Does the section fall apart into two legs below?
  bool has_legs() const { return crotch_.has_value(); }
  /// The height, m, below which the section falls apart into two legs: where the surface's cut with the plane
  /// x = 0 ends below. Throws InputError for a surface that does not part there into a left and a right leg.
  double crotch_height() const;

  // All of these throw InputError for a height y, m, at which there is no body.

  /// The perimeter of the section's convex hull, m: what a tape says.
  double hull_girth(double y) const;
  /// The girth of one leg: of the section's part at x < 0 for a negative `side`, else at x > 0. Throws
  /// InputError where the section reaches x = 0, as it does above the crotch, and where there is no such leg.
  double leg_girth(double y, int side) const;
  /// The part of that girth before the plane in which z, m, is given, which passes through the section.
  double front_share(double y, double z) const;
  /// How long a tape is from the front of the body at the height y, m, down between the legs and up to the
  /// back at the same height, in the plane x = 0; it bridges hollows. Throws InputError for a body without
  /// legs, and for a height below the crotch.
  double crotch_length(double y) const;
  /// The middle of the leg at x > 0, half way between the outermost points of its section; above the crotch
  /// that of the leg just below it, and below the body that of the leg just above its end.
  PlanPoint leg_middle(double y) const;
  /// The largest z of the section, m.
  double front(double y) const;
  /// The smallest z of the section, m.
  double back(double y) const;
  /// The largest |x| of the section, m.
  double half_width(double y) const;

 private:
  struct Interval {
    double low = 0, high = 0;
  };

  /// The corners of the section's outline, in no order.
  std::vector<PlanPoint> section(double y) const;
  /// Its part on one side of x = 0.
  std::vector<PlanPoint> leg_section(double y, int side) const;
  /// What `intervals` cover together, in pieces from below upwards.
  static std::vector<Interval> merged(std::vector<Interval> intervals);
  std::vector<Interval> heights_in_the_middle() const;
  std::optional<double> find_crotch() const;

  std::string name_;
  TrunkAndLegs body_;
  HeightSlices slices_;
  std::vector<Interval> middle_;  ///< heights at which the section reaches x = 0
  std::optional<double> crotch_;
};

/// A height of a body, and what a tape says there.
struct Landmark {
  double height = 0;            ///< m, above y = 0
  std::optional<double> girth;  ///< m, around the trunk or the thicker leg; none where legs are not apart
  bool by_proportion = false;  ///< the body shows nothing there, so that it is a share of the crotch's height
};

/// What trousers need to know of a body. ISO 8559-1 takes waist and knee at bones, which a surface does not
/// show: they are where it is narrowest.
struct BodyLandmarks {
  Landmark waist;            ///< the smallest girth between hip and chest
  Landmark hip;              ///< the greatest girth between crotch and waist
  double crotch_height = 0;  ///< m, above y = 0
  Landmark thigh;            ///< just below the crotch
  Landmark knee;             ///< the smallest girth between calf and thigh
  Landmark ankle;            ///< the smallest girth between foot and calf
};

/// Finds them on a body that stands on y = 0. Throws InputError for one without legs (BodyProfile).
BodyLandmarks find_landmarks(const BodyProfile& profile);

/// The girth of the thicker leg at a height, m; none where the legs are not apart or one does not reach.
std::optional<double> thicker_leg(const BodyProfile& profile, double y);

/// A body that has been read, or made, and measured.
struct MeasuredBody {
  Surface surface;      ///< all of it, m, as it is drawn
  std::string note;     ///< what a reader should know of how it was read, in a sentence; or empty
  BodyProfile profile;  ///< of trunk and legs, which patterns are cut for and garments meet
};

}  // namespace mssim
