#include <gtest/gtest.h>

#include <string_view>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "guide/work_precision.h"
#include "integrators/all_integrators.h"
#include "tests/support/cloth_system.h"

namespace mssim {
namespace {

/// Points of both Newton methods with a few steps over 20 ms, and where they ended.
struct Measured {
  System system = cloth_system(8, 8);
  TrustedState trusted =
      trusted_state(system, {.longest_s = 0.02, .first_dt_s = 1e-4, .seconds = 100, .wanted_error = 1e-7});
  std::vector<WorkPoint> points;
  std::vector<ImplicitEnd> ends;

  Measured() {
    for (const std::string_view name : {"implicit-euler", "newton-euler"})
      for (const int steps : {8, 16, 32}) {
        WorkPoint point;
        point.integrator = find_integrator(name);
        point.steps = steps;
        const auto backend = make_backend(*find_backend("serial"), system, *point.integrator,
                                          trusted.horizon_s / steps, {.threads = 1});
        backend->step(steps);
        ends.push_back({points.size(), backend->state()});
        point.position_error = position_deviation(system, trusted.state, ends.back().state);
        points.push_back(point);
      }
  }
};

TEST(ExactSteps, TellTheErrorOfTheSolverFromThatOfTheStep) {
  Measured measured;
  tell_errors_apart(measured.points, measured.ends, measured.system, measured.trusted, [] { return false; });
  for (const WorkPoint& point : measured.points) {
    ASSERT_TRUE(point.solver_error && point.step_error) << point.steps;
    EXPECT_LE(*point.position_error, *point.solver_error + *point.step_error);
    EXPECT_GE(*point.position_error, *point.step_error - *point.solver_error);
    // newton-euler solves the step's equation, to its tolerance and what single precision leaves.
    if (point.integrator->solver == Solver::newton)
      EXPECT_LT(*point.solver_error, 1e-3 * *point.step_error) << point.steps;
    else
      EXPECT_GT(*point.solver_error, 1e-2 * *point.step_error) << point.steps;
  }
  EXPECT_LT(*measured.points[1].step_error, *measured.points[0].step_error);
  EXPECT_LT(*measured.points[2].step_error, *measured.points[1].step_error);
  EXPECT_EQ(measured.points[0].step_error, measured.points[3].step_error);
}

TEST(ExactSteps, AreLeftOutWhereTimeIsOver) {
  Measured measured;
  int asked = 0;
  // Enough for the cheapest, which newton-euler took no time for, and not for the others.
  measured.points[4].seconds_a_step = 1;
  measured.points[5].seconds_a_step = 1;
  tell_errors_apart(measured.points, measured.ends, measured.system, measured.trusted,
                    [&] { return measured.points[0].step_error && ++asked > 2; });
  EXPECT_TRUE(measured.points[0].step_error);
  EXPECT_TRUE(measured.points[3].step_error);
  for (const std::size_t point : {1U, 2U, 4U, 5U}) EXPECT_FALSE(measured.points[point].step_error) << point;
}

}  // namespace
}  // namespace mssim
