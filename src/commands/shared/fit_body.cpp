#include "commands/shared/fit_body.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

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
  // A hand that was cut off takes some of the hip with it: cloth inside the whole body does not stand off.
  const auto whole = std::make_shared<const Solid>(body->surface);
  return {[solid](std::span<const Vec3d> points) { return solid->depths(points); },
          [body](const Vec3d& point) { return limb_middle(body->profile, point); },
          [whole, body](std::span<const Vec3d> points, double lowest, double highest) {
            const BandHull hull(body->profile.trunk_and_legs().surface, lowest, highest);
            std::vector<double> distances;
            for (const Vec3d& point : points)
              distances.push_back(
                  whole->depth(point) > 0 ? 0 : std::min(whole->distance(point), hull.distance(point)));
            return distances;
          }};
}

}  // namespace mssim
