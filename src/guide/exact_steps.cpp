#include "guide/exact_steps.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "backends/reference.h"
#include "bench/verification/blow_up.h"
#include "bench/verification/deviation.h"
#include "integrators/all_integrators.h"

namespace mssim {
namespace {

/// Exact backward Euler at the horizon; none where it diverges, or was stopped.
std::optional<State> exact_state(const System& system, const TrustedState& trusted, int steps,
                                 const std::function<bool()>& stop) {
  const auto backend =
      make_reference(system, *find_integrator("newton-euler"), trusted.horizon_s / steps, stop);
  for (int step = 0; step < steps; ++step) {
    backend->step(1);
    if (stop()) return std::nullopt;
  }
  State state = backend->state();
  if (first_bad_node(state)) return std::nullopt;
  return state;
}

/// Numbers of steps over the horizon, those that newton-euler took the least time for first.
std::vector<int> by_cost(std::span<const WorkPoint> points, std::span<const ImplicitEnd> ends) {
  std::map<int, double> seconds;
  for (const ImplicitEnd& end : ends)
    seconds.try_emplace(points[end.point].steps, std::numeric_limits<double>::infinity());
  for (const WorkPoint& point : points)
    if (const auto known = seconds.find(point.steps);
        known != seconds.end() && point.integrator->solver == Solver::newton)
      known->second = std::min(known->second, point.steps * point.seconds_a_step);
  std::vector<int> order;
  for (const auto& [steps, cost] : seconds) order.push_back(steps);
  std::ranges::stable_sort(order, {}, [&](int steps) { return seconds.at(steps); });
  return order;
}

}  // namespace

void tell_errors_apart(std::span<WorkPoint> points, std::span<const ImplicitEnd> ends, const System& system,
                       const TrustedState& trusted, const std::function<bool()>& stop) {
  for (const int steps : by_cost(points, ends)) {
    if (stop()) return;
    const std::optional<State> exact = exact_state(system, trusted, steps, stop);
    if (!exact) continue;
    const double step_error = position_deviation(system, trusted.state, *exact);
    for (const ImplicitEnd& end : ends)
      if (WorkPoint& point = points[end.point]; point.steps == steps) {
        point.solver_error = position_deviation(system, *exact, end.state);
        point.step_error = step_error;
      }
  }
}

}  // namespace mssim
