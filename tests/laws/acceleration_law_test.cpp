#include <gtest/gtest.h>

#include "laws/host_laws.h"

namespace mssim {
namespace {

TEST(AccelerationLaw, AddsSpringsDampingAndGravity) {
  const Vec3d a = node_acceleration(Vec3d{1, 2, 3}, Vec3d{4, 8, -2}, 0.5, 9.0);
  EXPECT_EQ(a, (Vec3d{-1, -11, 4}));
}

TEST(AccelerationLaw, IsTheSameUnfusedWhereNothingFuses) {
  float number = 0.1F;
  const auto next = [&number] { return number = 3.7F * number * (1 - number); };
  for (int i = 0; i < 1000; ++i) {
    const Vec3<float> pull{100 * next(), -100 * next(), 100 * next()}, v{next(), next(), -next()};
    const float damping = next(), gravity = 10 * next();
    EXPECT_EQ(node_acceleration(pull, v, damping, gravity),
              node_acceleration_unfused(pull, v, damping, gravity));
  }
}

TEST(FloorLaw, TurnsAFallAroundAndSlowsASlide) {
  // The normal speed changes by 4 + 2 m/s, the sliding speed of 5 m/s by 0.5 of that: two fifths are left.
  const Vec3d v = floor_velocity(Vec3d{3, -4, -4}, 0.5, 0.5);
  EXPECT_NEAR(v.x, 1.2, 1e-12);
  EXPECT_EQ(v.y, 2);
  EXPECT_NEAR(v.z, -1.6, 1e-12);
}

TEST(FloorLaw, StopsASlideThatIsSlowerThanFriction) {
  EXPECT_EQ(floor_velocity(Vec3d{0.3, -4, 0.4}, 0.5, 0.5), (Vec3d{0, 2, 0}));
}

}  // namespace
}  // namespace mssim
