#include "guide/work_precision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "guide/limits.h"
#include "integrators/all_integrators.h"
#include "model/energy.h"
#include "platform/machine.h"

namespace mssim {

namespace {

bool beats(const WorkPoint& a, const WorkPoint& b) {
  const double time = a.seconds_a_second(), other_time = b.seconds_a_second();
  const double error = *a.position_error, other_error = *b.position_error;
  return time <= other_time && error <= other_error && (time < other_time || error < other_error);
}

}  // namespace

void mark_pareto_front(std::span<WorkPoint> points) {
  for (WorkPoint& point : points)
    point.on_front = point.counts() && std::ranges::none_of(points, [&](const WorkPoint& other) {
                       return other.counts() && beats(other, point);
                     });
}

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

namespace {

std::optional<double> evaluations_of(const Integrator& integrator, const System& system) {
  switch (integrator.solver) {
    case Solver::none:
      return static_cast<double>(integrator.stage_count);
    case Solver::local_global:
      return system.solver.iterations;
    case Solver::constraints:
      return system.solver.substeps;
    case Solver::newton_step:
    case Solver::newton:
      break;
  }
  return std::nullopt;
}

/// What the state at the horizon says.
void take_state(WorkPoint& point, const System& system, const TrustedState& trusted, const State& state) {
  if (first_bad_node(state)) {
    point.diverged = true;
    return;
  }
  const Deviation deviation = deviation_from(system, trusted.state, trusted.energy, state);
  if (!std::isfinite(deviation.position) || !std::isfinite(deviation.energy)) {
    point.diverged = true;
    return;
  }
  point.position_error = deviation.position;
  point.energy_error = deviation.energy;
  point.diverged = !(energy_of(system, state).total() <= energy_bound(system, trusted.horizon_s));
  point.beyond_trust = deviation.position < trusted_margin * trusted.error();
}

}  // namespace

int first_steps(const Integrator& integrator, const StableStep& limit, double horizon_s) {
  const int fewest = std::max(1, static_cast<int>(std::ceil(horizon_s / longest_useful_step_s - 1e-9)));
  if (is_implicit(integrator) || limit.stable_s <= 0) return fewest;
  // A twentieth below the limit: it was found to a fiftieth, by other runs than that over the horizon.
  const int stable = std::max(1, static_cast<int>(std::ceil(horizon_s / (0.95 * limit.stable_s))));
  return std::max(fewest, (stable + 1) / 2);
}

WorkCurve::WorkCurve(const System& system, const TrustedState& trusted, const StepLimit& limit,
                     GuidedMethod& method, const ExecutionOptions& execution, double wanted_error)
    : system_(system),
      trusted_(trusted),
      method_(method),
      execution_(execution),
      wanted_error_(wanted_error),
      stable_s_(limit.measured.stable_s),
      steps_(first_steps(*method.integrator, limit.measured, trusted.horizon_s)),
      next_seconds_(limit.first_seconds + steps_ * limit.step_seconds) {
  if (!limit.status.empty())
    end(limit.status);
  else if (stable_s_ == 0 && !is_implicit(*method.integrator))
    end(limit.measured.finished ? "no step that was tried is stable"
                                : "no time was left to find a step that is stable");
  else if (stable_s_ == 0)
    method_.status = limit.measured.finished
                         ? "no step that was tried is stable beyond the horizon"
                         : "no time was left to find a step that is stable beyond the horizon";
}

void WorkCurve::end(std::string_view why) {
  has_next_ = false;
  if (method_.status.empty()) method_.status = why;
}

bool WorkCurve::goes_on_after(const WorkPoint& point) {
  constexpr int fewest = 4, most = 11;
  constexpr double largest_rounding = 0.02;  // of a rest length: what roundings have come to within a horizon
  if (points_ >= most) return false;
  if (points_ < fewest || !point.counts()) return !point.beyond_trust;
  if (*point.position_error <= wanted_error_ / 4) return false;
  if (last_error_ && *point.position_error >= 0.9 * *last_error_ &&
      *point.position_error < largest_rounding) {
    end("smaller steps are no more accurate: single precision rounds");
    return false;
  }
  return true;
}

std::optional<MeasuredPoint> WorkCurve::next() {
  constexpr double enough_s = 0.03;
  const Stopwatch watch;
  WorkPoint point;
  point.integrator = method_.integrator;
  point.backend = method_.backend->name;
  point.steps = steps_;
  point.dt_s = trusted_.horizon_s / steps_;
  has_next_ = false;
  State state;
  const auto measure = [&] {
    const auto backend = make_backend(*method_.backend, system_, *method_.integrator, point.dt_s, execution_);
    const StepTime time = time_steps(*backend, system_, steps_, enough_s);
    point.seconds_a_step = time.seconds;
    point.samples = time.runs;
    state = backend->state();
    point.note = backend->note();
  };
  if (!succeeds(*method_.backend, method_.status, method_.late, measure)) return std::nullopt;
  point.evaluations = evaluations_of(*method_.integrator, system_);
  take_state(point, system_, trusted_, state);
  point.within_limit = point.dt_s <= stable_s_ * (1 + 1e-9);
  ++points_;
  has_next_ = goes_on_after(point);
  last_error_ = point.counts() ? point.position_error : std::nullopt;
  next_seconds_ = 2 * watch.seconds();
  steps_ *= 2;
  return MeasuredPoint{std::move(point), std::move(state)};
}

}  // namespace mssim
