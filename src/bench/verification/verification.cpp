#include "bench/verification/verification.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "backends/backends.h"
#include "integrators/stability.h"
#include "model/spectrum.h"
#include "model/system.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {

std::optional<std::size_t> first_bad_node(const State& state) {
  const auto is_single = [](const Vec3d& a) {
    constexpr double largest = std::numeric_limits<float>::max();
    return std::abs(a.x) <= largest && std::abs(a.y) <= largest && std::abs(a.z) <= largest;
  };
  for (std::size_t i = 0; i < state.position.size(); ++i)
    if (!is_single(state.position[i]) || !is_single(state.velocity[i])) return i;
  return std::nullopt;
}

std::optional<BlowUp> find_blow_up(Backend& backend, const State& from, int steps) {
  return find_blow_up(
      [&](int count) {
        backend.set_state(from);
        backend.step(count);
        return first_bad_node(backend.state());
      },
      steps);
}

std::optional<BlowUp> find_blow_up(const std::function<std::optional<std::size_t>(int steps)>& bad_node_after,
                                   int steps) {
  int good = 0, bad = steps;
  std::optional<std::size_t> node = bad_node_after(bad);
  if (!node) return std::nullopt;
  while (bad - good > 1) {
    const int middle = good + (bad - good) / 2;
    if (const auto found = bad_node_after(middle)) {
      bad = middle;
      node = found;
    } else {
      good = middle;
    }
  }
  return BlowUp{bad, *node};
}

std::string describe(const BlowUp& blow_up, double dt_s, std::int64_t steps_before) {
  const std::int64_t step = steps_before + blow_up.step;
  std::ostringstream text;
  text << "blew up at step " << step << " (t = " << static_cast<double>(step) * dt_s << " s): node "
       << blow_up.node << " is not finite in single precision; take a smaller dt_s or \"auto\"";
  return text.str();
}

double position_deviation(const System& system, const State& reference, const State& state) {
  double largest = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const Vec3d d = state.position[i] - reference.position[i];
    largest = std::max(largest, dot(d, d));
  }
  return std::sqrt(largest) / mean_rest_length(system);
}

double energy_in_motion(const System& system, const State& state, const Energy& energy) {
  constexpr double share = 0.01, rounding = 8 * 0x1p-24;
  double rounded = 0;
  for (const Spring& spring : system.springs) {
    const Vec3d& x = state.position[spring.first];
    rounded += system.materials[spring.kind].stiffness / 2 * rounding * rounding * dot(x, x) / 3;
  }
  // Of what has no springs that resist, and does not move, nothing.
  return std::max({energy.kinetic + energy.elastic, rounded / share, std::numeric_limits<double>::min()});
}

Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state) {
  return {position_deviation(system, reference, state),
          (energy_of(system, state).total() - energy.total()) / energy_in_motion(system, reference, energy)};
}

namespace {

bool touches_floor(const System& system, const State& state) {
  return std::any_of(state.position.begin(), state.position.end(),
                     [&](const Vec3d& x) { return x.y <= system.floor.height; });
}

double largest_coordinate(const State& state) {
  double largest = 0;
  for (const Vec3d& x : state.position)
    largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  return largest;
}

}  // namespace

int position_roundings(const Integrator& integrator) {
  if (is_implicit(integrator)) return 1;
  return static_cast<int>(std::ranges::count_if(
      integrator.stages, [](const Stage& stage) { return writes(stage, Slot::x_next); }));
}

double position_tolerance(const System& system, const Integrator& integrator, int steps) {
  constexpr double unit_roundoff = 0x1p-24;
  return 4 * std::sqrt(static_cast<double>(steps) * position_roundings(integrator)) * unit_roundoff *
         largest_coordinate(system.start) / mean_rest_length(system);
}

int comparable_steps(const System& system, const Integrator& integrator, double dt_s, int most) {
  const auto factor = [&](double stiffness, double damping) {
    return largest_amplification(integrator, dt_s, {stiffness, damping, system.viscous_damping});
  };
  const StiffnessBound bound = stiffness_bound(system);
  if (is_implicit(integrator) || factor(bound.stiffness, bound.damping) <= 1 + tolerated_growth) return most;
  // Gershgorin's bound on the stiffest mode is two to four times too large.
  const Spectrum spectrum = spectrum_at(system, system.start);
  const double growth = std::log(factor(spectrum.stiffness, spectrum.damping));
  return growth > 0 ? static_cast<int>(std::clamp<double>(std::log(2) / growth, 1, most)) : most;
}

std::string touches_at_once(int steps) {
  return "a node touches the floor within the first " + std::to_string(steps) +
         " steps, so nothing can be verified before contact; start the scene higher";
}

Reference run_reference(const System& system, const Integrator& integrator, double dt_s) {
  constexpr int stride = 10;
  Reference reference;
  std::unique_ptr<Backend> backend;
  try {
    backend = make_reference(system, integrator, dt_s);
  } catch (const Unsupported& reason) {
    reference.failure = std::string("there is no double-precision reference: ") + reason.what();
    return reference;
  }
  reference.state = system.start;
  State before = system.start;
  bool in_the_air = true;
  const int comparable = comparable_steps(system, integrator, dt_s, verification_steps);
  std::vector<double> step_seconds;
  // To the end even after contact: a blow-up may only show then.
  for (int steps = 0; steps < verification_steps;) {
    const int next = std::min(steps + stride, steps < comparable ? comparable : verification_steps);
    const auto start = std::chrono::steady_clock::now();
    backend->step(next - steps);
    State state = backend->state();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    step_seconds.push_back(taken.count() / (next - steps));
    if (const auto node = first_bad_node(state)) {
      const BlowUp blow_up =
          find_blow_up(*backend, before, next - steps).value_or(BlowUp{next - steps, *node});
      reference.failure = "the double-precision reference " + describe(blow_up, dt_s, steps);
      return reference;
    }
    steps = next;
    in_the_air = in_the_air && !touches_floor(system, state);
    if (in_the_air && steps <= comparable) {
      reference.state = state;
      reference.steps = steps;
    }
    before = std::move(state);
  }
  if (reference.steps == 0) {
    reference.failure = touches_at_once(std::min(stride, comparable));
    return reference;
  }
  reference.energy = energy_of(system, reference.state);
  reference.step_seconds = median(step_seconds);
  reference.tolerance = position_tolerance(system, integrator, reference.steps);
  return reference;
}

Verification verify(Backend& backend, const System& system, const Reference& reference, double dt_s) {
  Verification result;
  if (reference.failure) {
    result.failure = reference.failure;
    return result;
  }
  backend.set_state(system.start);
  backend.step(reference.steps);
  const State state = backend.state();
  if (first_bad_node(state)) {
    const auto blow_up = find_blow_up(backend, system.start, reference.steps);
    result.failure = blow_up ? describe(*blow_up, dt_s) : std::string(finite_in_the_next);
    return result;
  }
  result.state_hash = state_hash(state);
  const Deviation deviation = deviation_from(system, reference.state, reference.energy, state);
  result.position_error = deviation.position;
  result.energy_drift = deviation.energy;

  std::ostringstream why;
  if (!(result.position_error <= reference.tolerance)) {
    why << "position error " << result.position_error << " of a rest length exceeds " << reference.tolerance
        << " after " << pluralize(static_cast<std::uint64_t>(reference.steps), "step");
  } else if (!(std::abs(result.energy_drift) <= energy_tolerance)) {
    why << "energy is off by " << result.energy_drift << " of the energy in motion, more than "
        << energy_tolerance << ", after " << pluralize(static_cast<std::uint64_t>(reference.steps), "step");
  }
  if (!why.str().empty()) result.failure = why.str();
  return result;
}

}  // namespace mssim
