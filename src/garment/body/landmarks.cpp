#include "garment/body/landmarks.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "text/error.h"

namespace mssim {
namespace {

/// Where a landmark is looked for and where it is if the body does not show it, in heights of the crotch:
/// what is between the two on grown people and children alike, and where the reference body has it.
struct Search {
  double low, high, usual;
};
constexpr Search waist_search{1.16, 1.52, 1.35}, hip_search{1.05, 1.25, 1.12}, knee_search{0.46, 0.75, 0.60},
    ankle_search{0.06, 0.25, 0.12};

using Girth = std::function<std::optional<double>(double)>;

/// The height within the range at which the girth is least, or for a negative `sign` greatest. Where that is
/// at an end of the range, it is on the way to something else, and the usual height counts.
Landmark extreme(const Girth& girth, const Search& search, double crotch, double sign) {
  constexpr int steps = 100;
  int best = -1;
  double least = 0;
  for (int i = 0; i <= steps; ++i) {
    const double y = crotch * (search.low + (search.high - search.low) * i / steps);
    const std::optional<double> there = girth(y);
    if (!there || (best >= 0 && sign * *there >= least)) continue;
    best = i;
    least = sign * *there;
  }
  const bool shows = best > 0 && best < steps;
  const double fraction = shows ? search.low + (search.high - search.low) * best / steps : search.usual;
  return {crotch * fraction, girth(crotch * fraction), !shows};
}

}  // namespace

std::optional<double> thicker_leg(const BodyProfile& profile, double y) {
  try {
    return std::max(profile.leg_girth(y, -1), profile.leg_girth(y, 1));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

BodyLandmarks find_landmarks(const BodyProfile& profile) {
  constexpr double below_the_crotch = 0.01;  // m
  const double crotch = profile.crotch_height();
  const Girth trunk = [&](double y) -> std::optional<double> {
    if (y >= profile.highest()) return std::nullopt;
    return profile.hull_girth(y);
  };
  const Girth leg = [&](double y) { return thicker_leg(profile, y); };
  BodyLandmarks found;
  found.crotch_height = crotch;
  found.hip = extreme(trunk, hip_search, crotch, -1);
  Search above_the_hip = waist_search;
  above_the_hip.low = std::max(above_the_hip.low, found.hip.height / crotch);
  found.waist = extreme(trunk, above_the_hip, crotch, 1);
  found.thigh = {crotch - below_the_crotch, leg(crotch - below_the_crotch), false};
  found.knee = extreme(leg, knee_search, crotch, 1);
  found.ankle = extreme(leg, ankle_search, crotch, 1);
  return found;
}

}  // namespace mssim
