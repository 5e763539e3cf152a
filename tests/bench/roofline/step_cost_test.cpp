#include "bench/roofline/step_cost.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrators/all_integrators.h"
#include "tests/support/cloth_system.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

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
using Real = Counted;
#define MSSIM_LAW inline Real
#include "kernels/spring_law.h"
#undef MSSIM_LAW

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
                                   Counted(10), Counted(20), Counted(0.5));
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
  EXPECT_EQ(cost.flops, 32.0 * 2094002 + (7.0 + 12.0) * 350000);
}

TEST(StepCost, OfTheMidpointRuleIsTheHandCount) {
  // Stage 1: x, v in; x_a, v_a out. Stage 2: x_a, v_a, x, v in; x_next, v_next out. Four lines of 2
  // operations.
  const StepCost cost = step_cost(*find_integrator("midpoint"), {100, 500});
  EXPECT_EQ(cost.bytes, (4 + 6) * 12.0 * 100);
  EXPECT_EQ(cost.flops, 2 * 32.0 * 500 + (2 * 7.0 + 4 * 6.0) * 100);
}

TEST(StepCost, OfRungeKuttaIsTheHandCount) {
  // Stage 1: 2 in, 4 out. Stages 2 and 3: trial pair, state and next in, 4 out. Stage 4: trial pair and next
  // in, next out. Fourteen lines of 2 operations.
  const StepCost cost = step_cost(*find_integrator("rk4"), {100, 500});
  EXPECT_EQ(cost.bytes, (6 + 10 + 10 + 6) * 12.0 * 100);
  EXPECT_EQ(cost.flops, 4 * 32.0 * 500 + (4 * 7.0 + 14 * 6.0) * 100);
}

TEST(StepCost, OfFrozenIntegratorsMovesNoMoreThanEulerAndComputesOneForce) {
  // rk4-frozen: v_1 = v + dt/2 a, v_2 = v + dt a, v+ = v + dt a: 2 each; x+ from four terms: 3 products, 3
  // sums.
  const StepCost cost = step_cost(*find_integrator("rk4-frozen"), {100, 500});
  EXPECT_EQ(cost.bytes, step_cost(*find_integrator("semi-euler"), {100, 500}).bytes);
  EXPECT_EQ(cost.flops, 32.0 * 500 + (7.0 + 3 * (3 * 2 + 6)) * 100);
}

TEST(StepCost, GrowsWithForceEvaluationsForEveryIntegrator) {
  for (const Integrator& integrator : integrators) {
    const double spring_flops =
        step_cost(integrator, {1000, 6000}).flops - step_cost(integrator, {1000, 0}).flops;
    EXPECT_EQ(spring_flops, 6000.0 * flops_per_spring * static_cast<double>(integrator.stage_count))
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

}  // namespace
}  // namespace mssim
