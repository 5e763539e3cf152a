#include "integrators/stability.h"

#include "integrators/all_integrators.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr double omega = 1e4;  // 1/s
const ModeBound undamped{omega * omega, 0, 0};

double limit(const char* name, const ModeBound& bound) {
  const Integrator* integrator = find_integrator(name);
  EXPECT_NE(integrator, nullptr) << name;
  return largest_stable_dt(*integrator, bound);
}

TEST(LargestStableDt, OfSemiImplicitEulerIsTwoOverOmega) {
  EXPECT_NEAR(limit("semi-euler", undamped) * omega, 2, 1e-6);
}

TEST(LargestStableDt, OfRungeKuttaIsTheLengthOfItsImaginaryAxis) {
  EXPECT_NEAR(limit("rk4", undamped) * omega, 2 * std::sqrt(2.), 1e-6);
}

TEST(LargestStableDt, OfTheUndampedMidpointRuleIsWhereItsGrowthReachesTheToleratedOne) {
  // |R|^2 = |1 + iz - z^2/2|^2 = 1 + z^4/4
  const double z = std::pow(4 * (std::pow(1 + tolerated_growth, 2) - 1), 0.25);
  EXPECT_NEAR(limit("midpoint", undamped) * omega, z, 1e-6 * z);
}

TEST(LargestStableDt, OfSemiImplicitEulerShrinksWithDamping) {
  // The matrix has determinant 1 - c dt and trace 2 - c dt - k dt^2; an eigenvalue is -1 where k dt^2 + 2 c
  // dt = 4.
  const double c = 0.5 * omega;
  const double dt = (-c + std::sqrt(c * c + 4 * omega * omega)) / (omega * omega);
  EXPECT_NEAR(limit("semi-euler", {omega * omega, c, 0}), dt, 1e-6 * dt);
}

TEST(LargestStableDt, OfTheMidpointRuleWithStiffnessProportionalDampingIsThatOfItsRealMethod) {
  // |1 + z + z^2/2| = 1 for the eigenvalue z of the stiffest mode.
  const double ratio = 0.26;  // of critical damping
  const double dt = limit("midpoint", {omega * omega, 2 * ratio * omega, 0});
  const double re = -ratio * omega * dt, im = std::sqrt(1 - ratio * ratio) * omega * dt;
  const double growth = std::hypot(1 + re + (re * re - im * im) / 2, im + re * im);
  EXPECT_NEAR(growth, 1, 2 * tolerated_growth);
  EXPECT_GT(omega * dt, 1.5);
}

TEST(LargestStableDt, OfAHeldAccelerationIsTwiceTheDampingOverTheStiffness) {
  // Determinant 1 - c dt + k dt^2/2 <= 1; here c/k is the same for all modes.
  const double c = 0.5 * omega;
  EXPECT_NEAR(limit("midpoint-frozen", {omega * omega, c, 0}) * omega, 1, 1e-4);
}

TEST(LargestStableDt, OfViscousDragAloneIsTwoOverTheDragForEveryMethodOfOrderOneAndTwo) {
  for (const char* name : {"semi-euler", "midpoint"})
    EXPECT_NEAR(limit(name, {0, 300, 300}) * 300, 2, 1e-5) << name;
}

TEST(LargestStableDt, OfStrongDragIsThatOfTheSoftestMode) {
  // A drag of 300 / s damps the stiffest mode, k = (300 / s)^2 / 4, critically: both its rates are 150 / s,
  // for which |1 + z + z^2/2| = 1 at 2 / 150 s. The faster rate of the softest, k = 0, is 300 / s.
  EXPECT_NEAR(limit("midpoint", {22500, 300, 300}) * 300, 2, 1e-5);
}

TEST(LargestStableDt, SeparatesDecayFromGrowthForEveryIntegrator) {
  const ModeBound bound{omega * omega, 0.4 * omega, 1};
  for (const Integrator& integrator : integrators) {
    const double dt = largest_stable_dt(integrator, bound);
    const double tolerated = 1 + tolerated_growth;
    bool grows = false;
    for (int i = 1; i <= 1000; ++i) {
      const double fraction = i * 1e-3, k = fraction * bound.stiffness,
                   c = 1 + fraction * (bound.damping - 1);
      EXPECT_LE(amplification(integrator, 0.999 * dt, k, c), tolerated)
          << integrator.name << " at " << fraction;
      grows |= amplification(integrator, 1.001 * dt, k, c) > tolerated;
    }
    EXPECT_TRUE(grows) << integrator.name;
  }
}

TEST(LargestStableDt, IsThatOfUndampedSpringsBesideDampedOnes) {
  // The stiffest springs alone bound an undamped mode; the others only add damping to stiffer ones.
  const double k = omega * omega;
  const ModeBound parts{1.1 * k, 0.4 * omega, 0, {{0.1 * k, 0.4 * omega}, {k, 0}}};
  EXPECT_NEAR(limit("midpoint", parts), limit("midpoint", undamped), 0.01 * limit("midpoint", undamped));
  EXPECT_LT(limit("midpoint", parts), limit("midpoint", {1.1 * k, 0.4 * omega, 0}) / 2);
  // A method that damping holds back meets the most damped mode, not the mean.
  EXPECT_LT(limit("semi-euler", parts), limit("semi-euler", {1.1 * k, 0, 0}));
  // In equal proportions, parts are as good as one.
  const ModeBound alike{
      k, 0.4 * omega, 1, {{0.6 * k, 0.6 * (0.4 * omega - 1)}, {0.4 * k, 0.4 * (0.4 * omega - 1)}}};
  for (const char* name : {"semi-euler", "midpoint", "rk4"})
    EXPECT_NEAR(limit(name, alike) / limit(name, {k, 0.4 * omega, 1}), 1, 1e-6) << name;
}

TEST(LargestStableDt, IsInfiniteWhereNothingActs) {
  for (const Integrator& integrator : integrators)
    EXPECT_EQ(largest_stable_dt(integrator, {}), std::numeric_limits<double>::infinity());
}

TEST(Amplification, IsThatOfStepsTakenOneByOne) {
  // The table's midpoint rule written out, against its spectral radius: an oscillator's envelope after many
  // steps.
  const double k = 4, c = 0.3, dt = 0.2;
  double x = 1, v = 0, earlier = 0;
  const int steps = 400, half = 200;
  for (int i = 0; i <= steps; ++i) {
    // A quantity that a step multiplies by the determinant, |eigenvalue|^2, exactly: x y' - y x' of two
    // solutions; here of (x, v) and its own next step.
    const double xs = x + dt / 2 * v, vs = v + dt / 2 * (-k * x - c * v);
    const double x1 = x + dt * vs, v1 = v + dt * (-k * xs - c * vs);
    const double area = x * v1 - v * x1;
    if (i == half) earlier = area;
    if (i == steps) {
      EXPECT_NEAR(std::sqrt(std::pow(area / earlier, 1. / (steps - half))),
                  amplification(*find_integrator("midpoint"), dt, k, c), 1e-12);
    }
    x = x1;
    v = v1;
  }
}

TEST(AutoDt, IsHalfOfTheSmallestLimitOfTheRealMethods) {
  const ModeBound bound{omega * omega, 0.4 * omega, 1};
  const double smallest =
      std::min({limit("semi-euler", bound), limit("midpoint", bound), limit("rk4", bound)});
  EXPECT_DOUBLE_EQ(auto_dt(bound), smallest / 2);
  const auto is_semi_euler = [](const Integrator& integrator) { return integrator.name == "semi-euler"; };
  EXPECT_DOUBLE_EQ(auto_dt(bound, is_semi_euler), limit("semi-euler", bound) / 2);
  EXPECT_GT(limit("semi-euler", bound), smallest);
}

TEST(AutoDt, IsNoLongerThanASceneMayHave) { EXPECT_EQ(auto_dt({1e-9, 0, 1}), 1); }

TEST(AutoDt, RefusesASystemThatDoesNotBoundIt) { EXPECT_THROW(auto_dt({}), std::invalid_argument); }

}  // namespace
}  // namespace mssim
