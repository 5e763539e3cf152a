#include "commands/shared/fit_body.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "garment/body/body_profile.h"
#include "garment/contact/solid.h"
#include "garment/scene/garment_body.h"

namespace mssim {
namespace {

struct Body {
  explicit Body(const Surface& surface) : profile(surface), solid(profile.trunk_and_legs().surface) {}

  BodyProfile profile;
  Solid solid;  ///< what the garment meets: an arm beside the hip is nothing to be inside of
};

/// The middle of the leg on the point's side, or of the trunk where that is nearer.
Vec3d limb_middle(const BodyProfile& profile, const Vec3d& point) {
  if (profile.has_legs()) {
    const PlanPoint leg = profile.leg_middle(point.y);
    if (std::abs(point.x) > leg.x / 2) return {point.x < 0 ? -leg.x : leg.x, point.y, leg.z};
  }
  const double height = std::clamp(point.y, profile.lowest(), profile.highest());
  return {0, point.y, (profile.front(height) + profile.back(height)) / 2};
}

}  // namespace

FitBody fit_body(const SceneSpec& spec) {
  const auto body = std::make_shared<const Body>(body_of_garment(spec));
  return {[body](std::span<const Vec3d> points) { return body->solid.depths(points); },
          [body](const Vec3d& point) { return limb_middle(body->profile, point); }};
}

}  // namespace mssim
