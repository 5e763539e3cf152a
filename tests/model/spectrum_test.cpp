#include "model/spectrum.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/cloth_system.h"
#include "tests/support/spring_chain.h"

namespace mssim {
namespace {

TEST(Spectrum, OfAChainIsThatOfItsClosedForm) {
  for (const std::uint32_t free : {1U, 2U, 7U, 40U}) {
    System system = spring_chain(free);
    system.materials[0].damping = 0.01;
    system.viscous_damping = 3;
    // 4 k/m sin^2(j pi / (2 (n + 1))) for j = 1 .. n.
    const double sine = std::sin(free * std::numbers::pi / (2 * (free + 1)));
    const Spectrum spectrum = spectrum_at(system, system.start);
    EXPECT_NEAR(spectrum.stiffness / (4 * 200 / 2e-5 * sine * sine), 1, 1e-3) << free;
    EXPECT_NEAR(spectrum.damping / (4 * 0.01 / 2e-5 * sine * sine + 3), 1, 1e-3) << free;
  }
}

TEST(Spectrum, OfAStrainedSpringHasWhatItDoesSideways) {
  System system = spring_chain(1);
  for (Spring& spring : system.springs) spring.rest_length = 0.005F;
  system.materials[0].stiffness = 1;
  // Along: 2 k/m. With springs of twice their length, sideways 2 k (1 - 1/2)/m, which is less.
  EXPECT_NEAR(spectrum_at(system, system.start).stiffness, 2 / 2e-5, 1e-3 * 2 / 2e-5);
  // Compressed to a quarter: sideways 2 k (1 - 4)/m, larger and of the other sign.
  for (Spring& spring : system.springs) spring.rest_length = 0.04F;
  EXPECT_NEAR(spectrum_at(system, system.start).stiffness, -2 * 3 / 2e-5, 1e-3 * 6 / 2e-5);
}

TEST(Spectrum, IsBelowGershgorinsBoundAndNotFarBelow) {
  const System system = cloth_system(12, 12);
  const Spectrum spectrum = spectrum_at(system, system.start);
  const StiffnessBound bound = stiffness_bound(system);
  EXPECT_LT(spectrum.stiffness, bound.stiffness);
  EXPECT_GT(spectrum.stiffness, 0.2 * bound.stiffness);
  EXPECT_LT(spectrum.damping, bound.damping);
}

}  // namespace
}  // namespace mssim
