#include "bench/roofline/roofline.h"

#include <chrono>

#include "integrators/all_integrators.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// A spring's, counted by hand: 6 for the differences, 10 for two products of vectors, 2 for the root, 5 for
/// the pull, 3 for the force and 6 to add it to both nodes.
constexpr double spring_flops = 32;

/// A number that counts what is done with it.
struct Counted {
  static inline int operations = 0;
  double value = 0;
  Counted() = default;
  Counted(double v)
      : value(v) {}  // NOLINT(google-explicit-constructor): stands for a float in the law's text
  friend Counted operator+(Counted a, Counted b) { return ++operations, Counted(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return ++operations, Counted(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return ++operations, Counted(a.value * b.value); }
  friend Counted operator-(Counted a) { return {-a.value}; }
};
Counted mul_add(Counted a, Counted b, Counted c) { return a * b + c; }
Counted inverse_sqrt(Counted a) {
  Counted::operations += 2;
  return {1 / std::sqrt(a.value)};
}
struct CountedVector {
  Counted x, y, z;
};

TEST(StepCost, CountsASpringAsTheLawIsWritten) {
  const CountedVector x{1, 2, 3}, other_x{2, 4, 7}, v{0, 1, 0}, other_v{3, 1, 2};
  CountedVector force, other_force;
  Counted::operations = 0;
  const CountedVector d{other_x.x - x.x, other_x.y - x.y, other_x.z - x.z};
  const CountedVector u{other_v.x - v.x, other_v.y - v.y, other_v.z - v.z};
  const Counted pull = spring_pull(d.x * d.x + d.y * d.y + d.z * d.z, u.x * d.x + u.y * d.y + u.z * d.z,
                                   LinearSpring<Counted>{{10, 0.5}, 20});
  const CountedVector f{pull * d.x, pull * d.y, pull * d.z};
  force = {force.x + f.x, force.y + f.y, force.z + f.z};
  other_force = {other_force.x - f.x, other_force.y - f.y, other_force.z - f.z};
  EXPECT_EQ(static_cast<std::size_t>(Counted::operations), flops_per_spring);
  // What was counted is a spring: Hooke's law with damping along it, by hand.
  const double length = std::sqrt(1. + 4 + 16),
               expected = 10 - 20 / length + 0.5 * (3 + 0 + 8) / (length * length);
  EXPECT_NEAR(force.x.value, expected, 1e-14);
  EXPECT_NEAR(other_force.z.value, -4 * expected, 1e-14);
}

TEST(StepCost, OfSemiImplicitEulerIsTheHandCount) {
  // Reads x and v, writes both: 48 bytes. v + dt a and x + dt v: 2 operations in 3 components each.
  const StepCost cost = step_cost(*find_integrator("semi-euler"), {350000, 2094002});
  EXPECT_EQ(cost.bytes, 48.0 * 350000);
  EXPECT_EQ(cost.flops, spring_flops * 2094002 + (7.0 + 12.0) * 350000);
}

TEST(StepCost, OfRungeKuttaIsTheHandCount) {
  // Stage 1: 2 in, 4 out. Stages 2 and 3: trial pair, state and next in, 4 out. Stage 4: trial pair and next
  // in, next out. Fourteen lines of 2 operations.
  const StepCost cost = step_cost(*find_integrator("rk4"), {100, 500});
  EXPECT_EQ(cost.bytes, (6 + 10 + 10 + 6) * 12.0 * 100);
  EXPECT_EQ(cost.flops, 4 * spring_flops * 500 + (4 * 7.0 + 14 * 6.0) * 100);
}

TEST(StepCost, OfFrozenIntegratorsMovesNoMoreThanEulerAndComputesOneForce) {
  // rk4-frozen: v_1 = v + dt/2 a, v_2 = v + dt a, v+ = v + dt a: 2 each; x+ from four terms: 3 products, 3
  // sums.
  const StepCost cost = step_cost(*find_integrator("rk4-frozen"), {100, 500});
  EXPECT_EQ(cost.bytes, step_cost(*find_integrator("semi-euler"), {100, 500}).bytes);
  EXPECT_EQ(cost.flops, spring_flops * 500 + (7.0 + 3 * (3 * 2 + 6)) * 100);
}

TEST(StepCost, GrowsWithForceEvaluationsForEveryIntegrator) {
  for (const Integrator& integrator : integrators) {
    const double flops_of_springs =
        step_cost(integrator, {1000, 6000}).flops - step_cost(integrator, {1000, 0}).flops;
    EXPECT_EQ(flops_of_springs, 6000.0 * spring_flops * static_cast<double>(integrator.stage_count))
        << integrator.name;
    EXPECT_GE(step_cost(integrator, {1000, 0}).bytes, 48.0 * 1000) << integrator.name;
  }
}

TEST(StepCost, MovesTheStateOnceAPassWhereStagesOverlap) {
  for (const Integrator& integrator : integrators) {
    const StepSize body{1000, 6000, 12};
    const double pass = 48.0 * 1000 + 12.0 * 6000;
    EXPECT_EQ(step_cost(integrator, body, 1).bytes, pass) << integrator.name;
    EXPECT_EQ(step_cost(integrator, body, 4).bytes, pass / 4) << integrator.name;
    EXPECT_EQ(step_cost(integrator, body, 4).flops, step_cost(integrator, body).flops) << integrator.name;
  }
}

TEST(WorkingSet, HoldsThePairsThatAStepCannotDoWithout) {
  EXPECT_EQ(working_set_bytes(*find_integrator("semi-euler"), {2500, 15000}), 24.0 * 2500);
  EXPECT_EQ(working_set_bytes(*find_integrator("midpoint"), {2500, 15000}), 48.0 * 2500);
  EXPECT_EQ(working_set_bytes(*find_integrator("rk4"), {2500, 15000}), 72.0 * 2500);
}

TEST(StepCost, OfABodyReadsItsSpringsInEveryStage) {
  // Two indices and a rest length, 12 bytes, for each unique spring and force evaluation; nothing else
  // changes.
  for (const Integrator& integrator : integrators) {
    const StepCost grid = step_cost(integrator, {1000, 6000}), body = step_cost(integrator, {1000, 6000, 12});
    EXPECT_EQ(body.bytes - grid.bytes, 12.0 * 6000 * static_cast<double>(integrator.stage_count))
        << integrator.name;
    EXPECT_EQ(body.flops, grid.flops) << integrator.name;
  }
}

TEST(StepCost, OfAlikeBodiesReadsTheSpringsThatTheyShareOnce) {
  for (const Integrator& integrator : integrators) {
    const StepSize all{1000, 6000, 12}, shared = with_stored_springs(all, 1500);
    EXPECT_EQ(shared.springs, 6000U);
    EXPECT_EQ(step_cost(integrator, all).bytes - step_cost(integrator, shared).bytes,
              12.0 * 4500 * static_cast<double>(integrator.stage_count))
        << integrator.name;
    EXPECT_EQ(step_cost(integrator, all).flops, step_cost(integrator, shared).flops) << integrator.name;
    EXPECT_EQ(working_set_bytes(integrator, all) - working_set_bytes(integrator, shared), 12.0 * 4500);
  }
  EXPECT_EQ(with_stored_springs({1000, 0, 12}, 0).springs, 0U);  // nodes that nothing joins
}

TEST(WorkingSet, HoldsTheSpringsOfABodyOnce) {
  EXPECT_EQ(working_set_bytes(*find_integrator("rk4"), {2500, 15000, 12}), 72.0 * 2500 + 12.0 * 15000);
}

TEST(StepSize, FollowsFromTheSystem) {
  const System cloth = cloth_system(10, 20), body = solid_block(2, 2, 2);
  EXPECT_EQ(step_size(cloth).nodes, 200U);
  EXPECT_EQ(step_size(cloth).springs, count_springs(10, 20));
  EXPECT_EQ(step_size(cloth).bytes_per_spring, 0);
  EXPECT_EQ(step_size(body).nodes, 8U);
  EXPECT_EQ(step_size(body).springs, 19U);  // 12 edges, a diagonal in each of 6 faces, one through the cube
  EXPECT_EQ(step_size(body).bytes_per_spring, 12);
}

constexpr std::size_t in_first_level = 16 << 10;

/// The best rate of many calls of `work`, each of which does `amount`.
template <class Work>
double best_rate(double amount, const Work& work) {
  double seconds = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds =
        std::min(seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return amount / seconds;
}

constexpr double slack_for_a_busy_machine = 0.8;

TEST(MachinePeak, IsNotBelowWhatPlainLoopsReach) {
  constexpr std::size_t size = in_first_level / 12, passes = 100;
  std::vector<float> a(size), b(size, 1), c(size, 2);
  const double triad = best_rate(12.0 * size * passes, [&] {
    for (std::size_t pass = 0; pass < passes; ++pass) {
      for (std::size_t i = 0; i < size; ++i) a[i] = b[i] + 0.5F * c[i];
      asm volatile("" : : "r"(a.data()) : "memory");  // every pass counts
    }
  });
  std::array<float, 8> chains{0, 1, 2, 3, 4, 5, 6, 7};
  constexpr std::size_t rounds = 20'000;
  const double multiply_adds = best_rate(2.0 * chains.size() * rounds, [&] {
    for (std::size_t round = 0; round < rounds; ++round)
      for (float& chain : chains) chain = chain * 0.5F + 1;
    asm volatile("" : : "r"(chains.data()) : "memory");
  });
  const MachinePeak peak = measure_peak(1, in_first_level);
  EXPECT_GT(peak.bytes_per_second, slack_for_a_busy_machine * triad);
  EXPECT_GT(peak.flops_per_second, slack_for_a_busy_machine * multiply_adds);
}

TEST(MachinePeak, WorksForAnyWorkingSetAndMoreThreadsThanCores) {
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{5000}}) {
    const MachinePeak peak = measure_peak(3, bytes);
    EXPECT_TRUE(std::isfinite(peak.bytes_per_second) && peak.bytes_per_second > 0) << bytes;
    EXPECT_TRUE(std::isfinite(peak.flops_per_second) && peak.flops_per_second > 0) << bytes;
  }
}

TEST(RooflineFraction, ComparesWithTheRoofThatBounds) {
  const MachinePeak peak{100, 1000};
  EXPECT_DOUBLE_EQ(roofline_fraction({50, 100}, 1, peak), 0.5);  // bytes bound: 0.5 s against 0.1 s
  EXPECT_DOUBLE_EQ(roofline_fraction({10, 900}, 1, peak), 0.9);  // operations bound
  EXPECT_DOUBLE_EQ(roofline_fraction({10, 900}, 3, peak), 0.3);
}

}  // namespace
}  // namespace mssim
