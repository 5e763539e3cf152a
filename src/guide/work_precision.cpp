#include "guide/work_precision.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <cmath>
#include <cstdint>
#include <future>
#include <limits>
#include <map>
#include <random>
#include <utility>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Positions of all nodes, then their velocities, component by component.
using Numbers = std::vector<double>;

Vec3d vector_at(const Numbers& numbers, std::size_t node) {
  return {numbers[3 * node], numbers[3 * node + 1], numbers[3 * node + 2]};
}

void put_vector(Numbers& numbers, std::size_t node, const Vec3d& value) {
  numbers[3 * node] = value.x;
  numbers[3 * node + 1] = value.y;
  numbers[3 * node + 2] = value.z;
}

/// Computes the time derivative of positions and velocities. `force`: [nodes] N, scratch.
void find_rate(const System& system, const Numbers& now, std::vector<Vec3d>& force, Numbers& rate) {
  const std::size_t nodes = system.nodes();
  std::ranges::fill(force, Vec3d{});
  for (const Spring& spring : system.springs) {
    const Vec3d d = vector_at(now, spring.second) - vector_at(now, spring.first);
    const Vec3d u = vector_at(now, nodes + spring.second) - vector_at(now, nodes + spring.first);
    const auto law = linear_spring(system.materials[spring.kind], static_cast<double>(spring.rest_length));
    const Vec3d pull = spring_pull(dot(d, d), dot(u, d), law) * d;
    force[spring.first] += pull;
    force[spring.second] -= pull;
  }
  for (std::size_t node = 0; node < nodes; ++node) {
    const Vec3d v = vector_at(now, nodes + node);
    put_vector(rate, node, v);
    put_vector(rate, nodes + node,
               node_acceleration((1 / system.node_mass[node]) * force[node], v, system.viscous_damping,
                                 system.gravity));
  }
  for (const std::uint32_t pin : system.pins) {
    put_vector(rate, pin, {});
    put_vector(rate, nodes + pin, {});
  }
}

/// The system's start with every free node moved by up to `distance`.
State neighbour_of(const System& system, double distance_m) {
  std::mt19937 random(19630301);  // any fixed seed: the same neighbour each time, with one standard library
  std::uniform_real_distribution<double> component(-distance_m, distance_m);
  State state = system.start;
  for (Vec3d& x : state.position) x += Vec3d{component(random), component(random), component(random)};
  for (const std::uint32_t node : system.pins) state.position[node] = system.start.position[node];
  return state;
}

/// A trajectory up to the end of a horizon.
struct Horizon {
  int steps = 0;
  double parting = 0;  ///< TrustedState::parting
  State state;
  std::string why;  ///< which condition ended it; empty: none
};

/// Follows two neighbouring trajectories of rk4 for at most `looks` times `steps` steps, until a condition of
/// a horizon or `stop` ends them.
Horizon find_horizon(const System& system, double dt_s, int looks, int steps,
                     const std::function<bool()>& stop) {
  // A node that reaches the floor stays below it until the next look finds it.
  const System floorless = without_floor(system);
  const auto near = make_reference(floorless, *find_integrator("rk4"), dt_s),
             beside = make_reference(floorless, *find_integrator("rk4"), dt_s);
  const State neighbour = neighbour_of(system, 1e-7 * mean_rest_length(system));
  const double first_distance = position_deviation(system, system.start, neighbour);
  beside->set_state(neighbour);
  Horizon horizon;
  for (int look = 0; look < looks && !stop(); ++look) {
    const OnAllProcessCpus unbound;  // a thread not started by OpenMP would share this thread's CPU
    std::future<void> others = std::async(as_the_system_can, [&] { beside->step(steps); });
    near->step(steps);
    others.get();
    State state = near->state();
    const double parting = position_deviation(system, state, beside->state()) / first_distance;
    horizon.why = first_bad_node(state)                 ? "the trajectory cannot be followed any longer"
                  : !is_in_the_air(state, system.floor) ? "a node reaches the floor"
                  : !(parting <= allowed_parting)       ? "neighbouring trajectories part"
                                                        : "";
    if (!horizon.why.empty()) break;
    horizon = {horizon.steps + steps, parting, std::move(state), {}};
  }
  return horizon;
}

constexpr double enough_s = 0.03;  // for the runs of a point
constexpr std::size_t fewest_points = 4, most_points = 11;

/// Wall seconds per step of rk4 in double precision.
double seconds_a_step(const System& system, double dt_s) {
  constexpr int steps = 3;
  const auto backend = make_reference(system, *find_integrator("rk4"), dt_s);
  const Stopwatch watch;
  backend->step(steps);
  return watch.seconds() / steps;
}

bool beats(const WorkPoint& a, const WorkPoint& b) {
  const double time = a.seconds_a_second(), other_time = b.seconds_a_second();
  const double error = *a.position_error, other_error = *b.position_error;
  return time <= other_time && error <= other_error && (time < other_time || error < other_error);
}

/// The state of exact backward Euler at the horizon; none if it diverges or is stopped.
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

/// Numbers of steps over the horizon, in ascending order of newton-euler's time.
std::vector<int> by_cost(std::span<const GuidedMethod> methods, std::span<const ImplicitEnd> ends) {
  std::map<int, double> seconds;
  for (const ImplicitEnd& end : ends)
    seconds.try_emplace(end.method->points[end.point].steps, std::numeric_limits<double>::infinity());
  for (const GuidedMethod& method : methods)
    if (method.integrator->solver == Solver::newton)
      for (const WorkPoint& point : method.points)
        if (const auto known = seconds.find(point.steps); known != seconds.end())
          known->second = std::min(known->second, point.steps * point.seconds_a_step);
  std::vector<int> order;
  for (const auto& [steps, cost] : seconds) order.push_back(steps);
  std::ranges::stable_sort(order, {}, [&](int steps) { return seconds.at(steps); });
  return order;
}

std::optional<double> evaluations_of(const Integrator& integrator, const System& system) {
  if (!is_implicit(integrator)) return static_cast<double>(integrator.stage_count);
  if (integrator.solver == Solver::local_global) return system.solver.iterations;
  if (integrator.solver == Solver::constraints) return system.solver.substeps;
  return std::nullopt;
}

/// Reads the state after a run of `steps` steps, which took `run_s`. Throws BackendFailure for a program that
/// takes its steps only when the state is requested.
State prompt_state(Backend& backend, const System& system, int steps, double run_s) {
  constexpr int tries = 10;  // because a busy machine delays single readings
  double postponed_s = std::numeric_limits<double>::infinity();
  for (int tried = 0; tried < tries; ++tried) {
    if (tried > 0) {
      backend.set_state(system.start);
      const Stopwatch watch;
      backend.step(steps);
      run_s = watch.seconds();
    }
    TimedState end = read_state(backend, system.start, run_s);
    postponed_s = std::min(postponed_s, end.postponed_s);
    if (postponed_s <= run_s) return std::move(end.state);
  }
  throw BackendFailure(describe_postponed(steps, run_s, postponed_s), "");
}

/// Sets the errors of a point from its state at the horizon.
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
  point.beyond_trust = deviation.position < trusted.least_error();
}

}  // namespace

std::optional<State> independent_state(const System& system, double span_s, double tolerance,
                                       const std::function<bool()>& stop) {
  const std::size_t nodes = system.nodes();
  Numbers numbers(6 * nodes);
  for (std::size_t node = 0; node < nodes; ++node) {
    put_vector(numbers, node, system.start.position[node]);
    put_vector(numbers, nodes + node, system.start.velocity[node]);
  }
  std::vector<Vec3d> force(nodes);
  // By reference, because the stepper copies the function.
  const auto rate = [&](const Numbers& now, Numbers& out, double /*time_s*/) {
    find_rate(system, now, force, out);
  };
  boost::numeric::odeint::bulirsch_stoer<Numbers> stepper(tolerance, 0);
  const double shortest = 1e-9 * span_s;
  double time_s = 0, step_s = span_s / 100;
  while (span_s - time_s > shortest) {
    if (stop() || step_s < shortest) return std::nullopt;
    double tried = step_s < span_s - time_s ? step_s : span_s - time_s;
    const bool last = tried < step_s;
    const auto result = stepper.try_step(rate, numbers, time_s, tried);
    if (!last || result == boost::numeric::odeint::fail) step_s = tried;
  }
  State state = system.start;
  for (std::size_t node = 0; node < nodes; ++node) {
    state.position[node] = vector_at(numbers, node);
    state.velocity[node] = vector_at(numbers, nodes + node);
  }
  for (const std::uint32_t pin : system.pins)  // without the rounding of extrapolation
    state.position[pin] = system.start.position[pin];
  return state;
}

TrustedState trusted_state(const System& system, const TrustedRequest& request) {
  constexpr double most_looks = 40;
  // Two neighbouring trajectories, then half the step and the other solver at once, which takes longer.
  constexpr double runs = 4;
  TrustedState trusted;
  const Stopwatch watch;
  const double step_seconds = seconds_a_step(system, request.first_dt_s);
  const double affordable_steps = request.seconds / runs / step_seconds;
  const double all_steps = request.longest_s / request.first_dt_s;
  // With fewer steps than checks, a horizon is too short for errors to grow.
  const double short_of_s =
      runs * step_seconds * (affordable_steps < most_looks ? std::min(most_looks, all_steps) : all_steps);
  if (affordable_steps < 1) {
    trusted.short_of_s = short_of_s;
    trusted.failure =
        fmt::format("no time is left for a reference, which takes {} s per step", three_digits(step_seconds));
    return trusted;
  }
  const double longest_s = std::min(request.longest_s, affordable_steps * request.first_dt_s);
  const int looks = static_cast<int>(std::min(most_looks, affordable_steps));
  const int steps_a_look = std::max(1, static_cast<int>(std::ceil(longest_s / looks / request.first_dt_s)));
  double dt_s = longest_s / looks / steps_a_look;
  const Horizon horizon = find_horizon(system, dt_s, looks, steps_a_look, request.stop);
  if (horizon.steps == 0) {
    trusted.failure = horizon.why.empty()
                          ? "it was stopped"
                          : fmt::format("there is no horizon for a comparison: {}, within {} s of the start",
                                        horizon.why, three_digits(longest_s / looks));
    return trusted;
  }
  trusted.horizon_s = horizon.steps * dt_s;
  trusted.parting = horizon.parting;
  const bool is_cut = horizon.why.empty() && longest_s < request.longest_s;
  trusted.why_there = !horizon.why.empty() ? "after that, " + horizon.why
                      : is_cut             ? "there is no time for a longer reference"
                                           : "the requested horizon";
  if (is_cut) trusted.short_of_s = short_of_s;

  const OnAllProcessCpus unbound;  // a thread not started by OpenMP would share this thread's CPU
  const auto out_of_time = [&] { return request.stop() || watch.seconds() > 2 * request.seconds; };
  std::future<std::optional<State>> other = std::async(as_the_system_can, [&] {
    return independent_state(system, trusted.horizon_s, 1e-8 * mean_rest_length(system), out_of_time);
  });
  State coarse = horizon.state;
  int steps = horizon.steps;
  do {
    steps *= 2;
    dt_s /= 2;
    const Stopwatch run_watch;
    const auto backend = make_reference(system, *find_integrator("rk4"), dt_s);
    backend->step(steps);
    trusted.state = backend->state();
    trusted.own_error = position_deviation(system, coarse, trusted.state) / 15;
    coarse = trusted.state;
    if (watch.seconds() + 2 * run_watch.seconds() > request.seconds) break;
  } while (trusted.own_error > request.wanted_error && !request.stop());
  if (trusted.own_error >
      request.wanted_error)  // a halving takes twice the time and a sixteenth of the error
    trusted.short_of_s = std::max(
        trusted.short_of_s, 2 * watch.seconds() * std::pow(trusted.own_error / request.wanted_error, 0.25));
  trusted.dt_s = dt_s;
  trusted.energy = energy_of(system, trusted.state);
  if (const std::optional<State> found = other.get())
    trusted.confirmed = position_deviation(system, *found, trusted.state);
  return trusted;
}

void mark_pareto_front(std::span<GuidedMethod> methods) {
  const auto is_beaten = [&](const WorkPoint& point) {
    return std::ranges::any_of(methods, [&](const GuidedMethod& method) {
      return std::ranges::any_of(
          method.points, [&](const WorkPoint& other) { return other.counts() && beats(other, point); });
    });
  };
  for (GuidedMethod& method : methods)
    for (WorkPoint& point : method.points) point.on_front = point.counts() && !is_beaten(point);
}

void tell_errors_apart(std::span<GuidedMethod> methods, std::span<const ImplicitEnd> ends,
                       const System& system, const TrustedState& trusted, const std::function<bool()>& stop) {
  for (const int steps : by_cost(methods, ends)) {
    if (stop()) return;
    const std::optional<State> exact = exact_state(system, trusted, steps, stop);
    if (!exact) continue;
    const double step_error = position_deviation(system, trusted.state, *exact);
    for (const ImplicitEnd& end : ends)
      if (WorkPoint& point = end.method->points[end.point]; point.steps == steps) {
        point.solver_error = position_deviation(system, *exact, end.state);
        point.step_error = step_error;
      }
  }
}

int first_steps(const Integrator& integrator, const StableStep& limit, double horizon_s) {
  const int fewest = std::max(1, static_cast<int>(std::ceil(horizon_s / longest_useful_step_s - 1e-9)));
  if (is_implicit(integrator) || limit.stable_s <= 0) return fewest;
  const int stable = std::max(1, static_cast<int>(std::ceil(horizon_s / (usable_share * limit.stable_s))));
  return std::max(fewest, (stable + 1) / 2);
}

WorkCurve::WorkCurve(const System& system, const TrustedState& trusted, const StepLimit& limit,
                     GuidedMethod& method, const ExecutionOptions& execution, double wanted_error)
    : system_(system),
      trusted_(trusted),
      limit_(limit),
      method_(method),
      execution_(execution),
      wanted_error_(wanted_error),
      steps_(first_steps(*method.integrator, limit.measured, trusted.horizon_s)),
      setup_seconds_(limit.first_seconds) {
  const bool is_explicit = !is_implicit(*method.integrator);
  if (is_explicit && limit.backend == method.backend->name) method_.step_seconds = limit.step_seconds;
  next_seconds_ = setup_seconds_ + seconds_of_runs(steps_ * limit.step_seconds, enough_s);
  if (const std::string reason = unsupported_reason(*method.backend, *method.integrator); !reason.empty())
    end({Lack::unsupported, reason});
  else if (limit.ending.lack != Lack::nothing)
    end(limit.ending);
  else if (limit.measured.stable_s == 0) {
    const std::string why = limit.measured.finished ? "no step that was tried is stable"
                                                    : "no time was left to find a step that is stable";
    if (is_explicit)
      end({limit.lack(), why});
    else
      method_.ending = {limit.lack(), why + " beyond the horizon"};
  }
}

void WorkCurve::end(const Ending& ending) {
  has_next_ = false;
  if (method_.ending.status().empty()) method_.ending = ending;
}

bool WorkCurve::succeeds(const std::function<void()>& run) {
  Ending ending = ending_of(run);
  if (ending.lack == Lack::nothing) return true;
  method_.ending = std::move(ending);
  has_next_ = false;
  return false;
}

void WorkCurve::end_without_time() {
  method_.next = NextPoint{next_seconds_, trusted_.horizon_s / steps_,
                           static_cast<int>(most_points - method_.points.size() - 1)};
  end({Lack::time, method_.points.empty() ? "no time was left for any step"
                   : has_counted()        ? "no time was left for smaller steps"
                                          : "no time was left for a step that is stable"});
}

bool WorkCurve::has_counted() const { return std::ranges::any_of(method_.points, &WorkPoint::counts); }

double WorkCurve::seconds_of(int steps) const {
  return setup_seconds_ + seconds_of_runs(steps * method_.step_seconds, enough_s);
}

void WorkCurve::time_step() {
  const auto run = [&] {
    const Stopwatch watch;
    const auto backend = make_timed_backend(*method_.backend, system_, *method_.integrator,
                                            trusted_.horizon_s / (2 * steps_), execution_);
    setup_seconds_ = watch.seconds();
    method_.step_seconds = seconds_of_step(*backend, system_);
  };
  if (!succeeds(run)) return;
  next_seconds_ = seconds_of(steps_);
  if (method_.next) method_.next->seconds = next_seconds_;
}

bool WorkCurve::ends_with_same_error() {
  constexpr double largest_rounding = 0.02;  // of a rest length: seen as rounding error within a horizon
  constexpr double same = 0.01;
  const std::vector<WorkPoint>& points = method_.points;
  const double error = *points.back().position_error;
  const WorkPoint* before = points.size() > 1 ? &points[points.size() - 2] : nullptr;
  const auto last_error = before != nullptr && before->counts() ? before->position_error : std::nullopt;
  const bool is_rounded = error < largest_rounding;
  // Errors of implicit steps that are far too long hardly change at first.
  unchanged_ =
      !is_implicit(*method_.integrator) && last_error && std::abs(error - *last_error) < same * *last_error
          ? unchanged_ + 1
          : 0;
  if (points.size() < fewest_points || error <= wanted_error_ / 4) return false;
  if (unchanged_ < 2 && !(is_rounded && last_error && error >= 0.9 * *last_error)) return false;
  end({Lack::nothing, is_rounded ? "smaller steps are no more accurate: roundings"
                                 : "smaller steps are no more accurate: roundings, or the backend steps "
                                   "another system"});
  return true;
}

bool WorkCurve::goes_on() {
  constexpr int enough_diverged = 3;
  const std::vector<WorkPoint>& points = method_.points;
  const WorkPoint& point = points.back();
  if (point.counts() && ends_with_same_error()) return false;
  const auto diverged =
      std::ranges::count_if(points, [](const WorkPoint& one) { return one.diverged && one.within_limit; });
  // A step that is stable for a shorter time may diverge within the horizon.
  if (diverged == enough_diverged && !has_counted() && limit_.measured.span_s >= trusted_.horizon_s) {
    end({Lack::failed, fmt::format("its energy grows or is not finite with {} steps that should be stable",
                                   enough_diverged)});
    return false;
  }
  if (points.size() == most_points && !has_counted())
    end({Lack::stable_step, "no step that was tried is stable over the horizon"});
  if (points.size() == most_points) return false;
  if (points.size() < fewest_points || !point.counts()) return !point.beyond_trust;
  return *point.position_error > wanted_error_ / 4;
}

std::optional<State> WorkCurve::measure(int steps) {
  WorkPoint point;
  point.steps = steps;
  point.dt_s = trusted_.horizon_s / steps;
  State state;
  const auto run = [&] {
    const auto backend =
        make_timed_backend(*method_.backend, system_, *method_.integrator, point.dt_s, execution_);
    const StepTime time = time_steps(*backend, system_, steps, enough_s);
    point.seconds_a_step = time.seconds;
    point.samples = time.runs;
    state = prompt_state(*backend, system_, steps, time.seconds * steps);
    point.note = backend->note();
  };
  if (!succeeds(run)) return std::nullopt;
  method_.step_seconds = point.seconds_a_step;
  point.evaluations = evaluations_of(*method_.integrator, system_);
  take_state(point, system_, trusted_, state);
  point.within_limit = point.dt_s <= limit_.measured.stable_s * (1 + 1e-9);
  method_.points.push_back(std::move(point));
  return state;
}

std::optional<State> WorkCurve::next() {
  const Stopwatch watch;
  auto state = measure(steps_);
  if (!state) return std::nullopt;
  has_next_ = goes_on();
  next_seconds_ = 2 * watch.seconds();
  steps_ *= 2;
  return state;
}

}  // namespace mssim
