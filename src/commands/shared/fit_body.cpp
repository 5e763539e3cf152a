#include "commands/shared/fit_body.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "garment/contact/solid.h"

namespace mssim {
namespace {

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

FitBody fit_body(const std::shared_ptr<const MeasuredBody>& body) {
  // What the garment meets: an arm beside the hip is nothing to be inside of.
  const auto solid = std::make_shared<const Solid>(body->profile.trunk_and_legs().surface);
  return {[solid](std::span<const Vec3d> points) { return solid->depths(points); },
          [body](const Vec3d& point) { return limb_middle(body->profile, point); }};
}

}  // namespace mssim
