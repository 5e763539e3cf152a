#include <gtest/gtest.h>

#include "backends/backends.h"
#include "guide/limits.h"
#include "integrators/all_integrators.h"
#include "model/spectrum.h"
#include "tests/support/cloth_system.h"
#include "tests/support/spring_chain.h"

namespace mssim {
namespace {

StepMaker reference_of(const System& system, std::string_view integrator) {
  return [&system, &row = *find_integrator(integrator)](double dt_s) {
    return make_reference(system, row, dt_s);
  };
}

StepSearch search_from(double first_s) {
  return {
      .first_s = first_s, .longest_s = 100 * first_s, .shortest_s = first_s / 64, .span_s = 2000 * first_s};
}

TEST(StableStep, OfAnOscillatorIsTheKnownLimit) {
  const System system = fast_and_slow_oscillator();
  const double omega = oscillator_frequency(system);
  struct Known {
    std::string_view integrator;
    double limit;
  };
  for (const Known& known : {Known{"semi-euler", 2}, Known{"verlet", 2}, Known{"rk4", 2 * std::sqrt(2.0)}})
    for (const double first : {0.3, 1.0, 3.0}) {  // from below and from above
      const StableStep found = largest_stable_step(system, reference_of(system, known.integrator),
                                                   search_from(first * known.limit / omega));
      EXPECT_LE(found.stable_s, known.limit / omega * 1.0001) << known.integrator << ' ' << first;
      EXPECT_GE(found.stable_s * step_resolution * step_resolution, known.limit / omega)
          << known.integrator << ' ' << first;
      EXPECT_LE(found.unstable_s, step_resolution * found.stable_s) << known.integrator << ' ' << first;
      EXPECT_TRUE(found.finished);
    }
}

TEST(StableStep, OfExplicitEulerIsNoneWithoutDamping) {
  const System system = fast_and_slow_oscillator();
  const StableStep found = largest_stable_step(system, reference_of(system, "explicit-euler"),
                                               search_from(2 / oscillator_frequency(system)));
  EXPECT_EQ(found.stable_s, 0);
  EXPECT_GT(found.unstable_s, 0);
}

TEST(StableStep, OfExplicitEulerWithDampingIsTheDampingOverTheStiffness) {
  System system = spring_oscillator();
  system.materials[0].damping = 0.002;
  // x'' = -k x - c x' is stable under Euler's method up to dt = c / k where it oscillates.
  const double limit = 0.002 / 200;
  const StableStep found =
      largest_stable_step(system, reference_of(system, "explicit-euler"), search_from(3 * limit));
  EXPECT_NEAR(found.stable_s / limit, 1, 0.03);
}

TEST(StableStep, OfASmallClothIsThatOfItsSpectrum) {
  const System system = cloth_system(10, 10);
  const Spectrum spectrum = spectrum_at(system, system.start);
  for (const std::string_view name : {"semi-euler", "rk4"}) {
    const Integrator& integrator = *find_integrator(name);
    const StepTheory theory = step_theory(integrator, system, spectrum, spectrum);
    const StableStep found =
        largest_stable_step(system, reference_of(system, name), search_from(theory.bound_s));
    EXPECT_NEAR(found.stable_s / theory.at_start_s, 1, 0.05) << name;
    EXPECT_LT(theory.bound_s, theory.at_start_s) << name;
    EXPECT_EQ(why_they_differ(integrator, found, theory, false), "") << name;
  }
}

TEST(StableStep, IsSearchedForNoFartherThanAsked) {
  const System system = fast_and_slow_oscillator();
  const double limit = 2 / oscillator_frequency(system);
  StepSearch search = search_from(0.1 * limit);
  search.longest_s = 0.2 * limit;
  const StableStep found = largest_stable_step(system, reference_of(system, "semi-euler"), search);
  EXPECT_EQ(found.stable_s, search.longest_s);
  EXPECT_EQ(found.unstable_s, 0);
}

TEST(StableStep, SaysThatItsSearchWasStopped) {
  const System system = spring_oscillator();
  StepSearch search = search_from(0.1 / oscillator_frequency(system));
  search.stop = [] { return true; };
  const StableStep found = largest_stable_step(system, reference_of(system, "semi-euler"), search);
  EXPECT_FALSE(found.finished);
  EXPECT_EQ(found.runs, 1);
}

TEST(StableStep, EndsInAHurryWithABracket) {
  const System system = fast_and_slow_oscillator();
  const double limit = 2 / oscillator_frequency(system);
  StepSearch search = search_from(0.3 * limit);
  search.hurry = [] { return true; };
  const StableStep found = largest_stable_step(system, reference_of(system, "semi-euler"), search);
  EXPECT_FALSE(found.finished);
  EXPECT_GT(found.stable_s, 0);
  EXPECT_LE(found.stable_s, limit * 1.0001);
  EXPECT_GE(found.unstable_s, limit);
}

/// A cloth without pins that hangs a row above the floor, or high above it.
StepLimit limit_of_backward_euler(double ceiling_m) {
  SceneSpec spec = cloth_spec(10, 10);
  auto& cloth = std::get<ClothSpec>(spec.content);
  cloth.pins.reset();
  cloth.ceiling_height_m = ceiling_m;
  const System system = build_system(spec);
  const Spectrum spectrum = spectrum_at(system, system.start);
  const LimitRequest request{.system = &system,
                             .backends = {find_backend("serial")},
                             .execution = {},
                             .at_start = spectrum,
                             .on_the_way = spectrum,
                             .seconds = 1000,
                             .stop = [] { return false; }};
  return find_step_limit(*find_integrator("newton-euler"), request);
}

TEST(StepLimit, OfBackwardEulerIsTheFloors) {
  const StepLimit near = limit_of_backward_euler(0.1);
  EXPECT_GT(near.measured.unstable_s, 0);
  EXPECT_TRUE(near.floor_is_why);
  EXPECT_EQ(near.why.substr(0, 9), "the floor");
  const StepLimit high = limit_of_backward_euler(20);
  EXPECT_EQ(high.measured.unstable_s, 0);
  EXPECT_FALSE(high.floor_is_why);
  EXPECT_EQ(high.why, "");
}

TEST(StepTheory, SaysWhyAMeasuredStepIsAnotherOne) {
  const Integrator& euler = *find_integrator("semi-euler");
  const StepTheory theory{.at_start_s = 1, .on_the_way_s = 1, .bound_s = 0.5};
  const auto measured = [](double stable) {
    return StableStep{.stable_s = stable, .unstable_s = 1.01 * stable};
  };
  // Within a tenth up, or down by the same factor: 1 / 1.1 = 0.9091.
  EXPECT_EQ(why_they_differ(euler, measured(1.099), theory, false), "");
  EXPECT_EQ(why_they_differ(euler, measured(0.91), theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(1.101), theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(0.909), theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(1.5), theory, false).find("longer"), std::string::npos);
  EXPECT_NE(why_they_differ(euler, measured(0.5), theory, false).find("shorter"), std::string::npos);
  EXPECT_NE(why_they_differ(euler, measured(0.5), theory, true).find("floor"), std::string::npos);
  EXPECT_NE(why_they_differ(euler, {}, theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(1), {}, false), "");
  EXPECT_EQ(why_they_differ(euler, {}, {}, false), "");
}

}  // namespace
}  // namespace mssim
