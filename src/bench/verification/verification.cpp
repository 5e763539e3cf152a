#include "bench/verification/verification.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "backends/reference.h"
#include "bench/verification/blow_up.h"
#include "bench/verification/deviation.h"
#include "integrators/stability.h"
#include "model/spectrum.h"
#include "model/system.h"
#include "text/text.h"

namespace mssim {
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
  // To the end even after contact: a blow-up may only show then.
  for (int steps = 0; steps < verification_steps;) {
    const int next = std::min(steps + stride, steps < comparable ? comparable : verification_steps);
    backend->step(next - steps);
    State state = backend->state();
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
