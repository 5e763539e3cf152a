#include "laws/host_laws.h"
#include "tests/support/testing.h"

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

// A speed has no unit that the law may know: openmp counts time in steps.
TEST(FloorLaw, IsTheSameForSmallSpeeds) {
  constexpr float scale = 0x1p-60F;  // exact, and no square of these speeds is denormal
  for (const Vec3<float> v : {Vec3<float>{3, -2, 4}, Vec3<float>{0.5F, -8, 1}, Vec3<float>{0, -1, 0}}) {
    const Vec3<float> after = floor_velocity(v, 0.5F, 0.25F), slow = floor_velocity(scale * v, 0.5F, 0.25F);
    EXPECT_EQ(slow.x, scale * after.x);
    EXPECT_EQ(slow.y, scale * after.y);
    EXPECT_EQ(slow.z, scale * after.z);
  }
}

TEST(FloorLaw, StopsASlideThatIsSlowerThanFriction) {
  EXPECT_EQ(floor_velocity(Vec3d{0.3, -4, 0.4}, 0.5, 0.5), (Vec3d{0, 2, 0}));
}

constexpr double stiffness = 200, damping = 0.3, rest = 0.01;
const LinearSpring<double> spring = linear_spring({stiffness, damping}, rest);

/// The force on the first end of a spring, N.
Vec3d spring_force(const Vec3d& d, const Vec3d& u) { return spring_pull(dot(d, d), dot(u, d), spring) * d; }

/// By how much `force` changes from one side of zero to the other, a metre or m/s.
template <class Force>
Vec3d central_difference(double step, const Force& force) {
  return 1 / (2 * step) * (force(step) - force(-step));
}

constexpr std::array<Vec3d, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0.6, -0.48, 0.64}}};

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

/// Springs from a quarter of their rest length to four times.
class SpringJacobian : public testing::TestWithParam<double> {
 protected:
  Vec3d d() const { return GetParam() * rest * Vec3d{2. / 7, -3. / 7, 6. / 7}; }
  double inverse() const { return 1 / length(d()); }
  Vec3d n() const { return inverse() * d(); }
};
INSTANTIATE_TEST_SUITE_P(Lengths, SpringJacobian, testing::Values(0.25, 0.8, 1.0, 1.02, 4.0));

TEST_P(SpringJacobian, IsTheElasticForcesDerivativeByPosition) {
  const double across = spring_across(inverse(), spring);
  for (const Vec3d& p : directions)
    expect_near(spring_jacobian_times(n(), spring_along(spring), across, p),
                central_difference(1e-7, [&](double step) { return spring_force(d() + step * p, {}); }),
                1e-6 * stiffness);
}

TEST_P(SpringJacobian, IsTheDampingForcesDerivativeByVelocity) {
  const Vec3d u{0.3, 0.1, -0.2};
  for (const Vec3d& p : directions)
    expect_near(spring_jacobian_times(n(), spring_damping_along(spring.constants), 0.0, p),
                central_difference(0.1, [&](double step) { return spring_force(d(), u + step * p); }), 1e-12);
}

TEST_P(SpringJacobian, MadeDefiniteLeavesOutOnlyWhatCompressionTakes) {
  const double across = spring_across(inverse(), spring);
  const double definite = spring_across_definite(inverse(), spring);
  EXPECT_EQ(across < 0, GetParam() < 1);
  EXPECT_EQ(definite, GetParam() < 1 ? 0 : across);
}

TEST_P(SpringJacobian, AsABlockIsWhatItsProductsSay) {
  const Vec3d unit = n();
  const SymmetricBlock<double> block = spring_jacobian(unit.x, unit.y, unit.z, 7.0, 0.5);
  for (const Vec3d& p : directions)
    expect_near(block_times(block, p), spring_jacobian_times(unit, 7.0, 0.5, p), 1e-14);
}

TEST(SymmetricBlock, TimesItsInverseIsOne) {
  const SymmetricBlock<double> one{1, 0, 0, 1, 0, 1};
  const SymmetricBlock<double> block =
      block_sum(one, block_sum(spring_jacobian(0.6, 0.0, -0.8, 1e3, 0.3),
                               spring_jacobian(2. / 7, -3. / 7, 6. / 7, 50.0, 0.0)));
  const SymmetricBlock<double> inverse = block_inverse(block);
  for (const Vec3d& p : directions) {
    expect_near(block_times(inverse, block_times(block, p)), p, 1e-12);
    expect_near(block_times(block, block_times(inverse, p)), p, 1e-12);
  }
}

TEST(SymmetricBlock, HasAnInverseInSinglePrecisionFarFromOne) {
  const SymmetricBlock<float> block{2, 0.5, -0.25, 1, 0.125, 3}, inverse = block_inverse(block);
  for (const float factor : {0x1p-100F, 0x1p-45F, 0x1p-31F, 0x1p39F, 0x1p45F, 0x1p105F}) {
    const SymmetricBlock<float> scaled = block_inverse(block_scaled(factor, block)),
                                expected = block_scaled(1 / factor, inverse);
    EXPECT_TRUE(scaled.xx == expected.xx && scaled.xy == expected.xy && scaled.xz == expected.xz &&
                scaled.yy == expected.yy && scaled.yz == expected.yz && scaled.zz == expected.zz)
        << factor;
  }
}

}  // namespace
}  // namespace mssim
