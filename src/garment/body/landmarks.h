#pragma once

#include <optional>

#include "garment/body/body_profile.h"

namespace mssim {

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

}  // namespace mssim
