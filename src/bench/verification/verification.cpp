#include "bench/verification/verification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "backends/backends.h"
#include "integrators/stability.h"
#include "laws/host_laws.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr double unit_roundoff = 0x1p-24;  // of float

double largest_coordinate(const State& state) {
  double largest = 0;
  for (const Vec3d& x : state.position)
    largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  return largest;
}

constexpr std::size_t most_nodes = 1U << 20U;

/// Distance in node numbers between examined nodes.
std::size_t stride_of(std::size_t nodes) { return (nodes + most_nodes - 1) / most_nodes; }

/// Positions of the examined nodes.
std::vector<Vec3d> looked_at(const State& state, std::size_t first) {
  const std::size_t stride = stride_of(state.position.size());
  std::vector<Vec3d> positions;
  for (std::size_t i = first % stride; i < state.position.size(); i += stride)
    positions.push_back(state.position[i]);
  return positions;
}

double largest_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(a[i] - b[i]));
  return largest;
}

/// How far from the floor a system certainly stays for some steps. Between two looks a node may land and
/// bounce off.
class FloorWatch {
 public:
  /// `system` must outlive it; `start` is where its steps start.
  FloorWatch(const System& system, double dt_s, const State& start) : system_(system), dt_s_(dt_s) {
    const Energy energy = energy_of(system, start);
    // No node is faster than the lightest one with all this energy, but for what falling adds.
    fastest_ = std::sqrt(2 * (energy.kinetic + energy.elastic) / std::ranges::min(system.node_mass));
  }

  /// Steps to the next look at the floor, `steps` after the start: `most`, or one if a node may meet it
  /// before.
  int steps_to_look(const State& state, int steps, int most) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec3d& x : state.position) lowest = std::min(lowest, x.y);
    const double way = most * dt_s_ * (fastest_ + system_.gravity * (steps + most) * dt_s_);
    return lowest - system_.floor.height > way ? most : 1;
  }

 private:
  const System& system_;
  double dt_s_;
  double fastest_ = 0;  ///< m/s
};

/// The state, each number displaced at random, by less than what rounding it to single precision may do.
State displaced(State state, std::uint32_t number) {
  std::mt19937 random(number);
  const auto displace = [&](double& x) {
    x *= 1 + unit_roundoff * (static_cast<double>(random()) / 0x1p32 - 0.5);
  };
  for (std::vector<Vec3d>* vectors : {&state.position, &state.velocity})
    for (Vec3d& a : *vectors)
      for (double* x : {&a.x, &a.y, &a.z}) displace(*x);
  return state;
}

/// The reference, and copies that are rounded after every step, which only run if they are asked for.
class CheckedWay {
 public:
  static constexpr std::uint32_t most_copies = 3;

  /// `start` must outlive it.
  CheckedWay(const System& system, const Integrator& integrator, double dt_s, const State& start)
      : system_(system),
        integrator_(integrator),
        dt_s_(dt_s),
        start_(start),
        reference_(make_reference(system, integrator, dt_s)),
        watch_(system, dt_s, start),
        present_(start),
        lies_(system.nodes(), 0),
        landing_speeds_(system.nodes(), 0) {
    reference_->set_state(start);
  }

  void go_to(int steps) {
    while (steps_ < steps) {
      const int count = watch_.steps_to_look(present_, steps_, std::min(steps_between_looks, steps - steps_));
      const State before = std::move(present_);
      reference_->step(count);
      steps_ += count;
      present_ = reference_->state();
      for (std::size_t i = 0; i < present_.position.size(); ++i) {
        fastest_ = std::max(fastest_, length(present_.velocity[i]));
        const bool lies = present_.position[i].y <= system_.floor.height;
        if (lies && lies_[i] == 0) {
          const double speed = std::max(length(before.velocity[i]), length(present_.velocity[i]));
          landing_speeds_[i] += speed;
          momentum_ += system_.node_mass[i] * speed;
        }
        lies_[i] = lies ? 1 : 0;
      }
    }
  }

  const State& state() const { return present_; }
  /// Distance in m by which roundings may move a node that has met the floor: each of its landings may be
  /// early or late by a few steps. 0 if none has met it.
  double landing_distance() const {
    const double most = std::ranges::max(landing_speeds_);
    return most > 0 ? late_s() * std::max(fastest_, most) : 0;
  }
  /// Energy in J that landings at other times may add or take: meanwhile a node falls on.
  double landing_energy() const { return late_s() * system_.gravity * momentum_; }
  /// State of a rounded copy after as many steps. The starts of all but the first are displaced.
  State rounded(std::uint32_t number) {
    Copy& copy = copies_.at(number);
    if (!copy.backend) {
      copy.backend = make_reference(system_, integrator_, dt_s_);
      copy.backend->set_state(number == 0 ? start_ : displaced(start_, number));
    }
    const int steps = steps_ - std::exchange(copy.steps, steps_);
    return step_rounded(*copy.backend, integrator_.ahead * dt_s_, steps);
  }

 private:
  struct Copy {
    std::unique_ptr<Backend> backend;
    int steps = 0;
  };

  double late_s() const { return 4 * dt_s_; }

  const System& system_;
  const Integrator& integrator_;
  double dt_s_;
  const State& start_;
  std::unique_ptr<Backend> reference_;
  std::array<Copy, most_copies> copies_;
  FloorWatch watch_;
  State present_;
  int steps_ = 0;
  double fastest_ = 0;                  ///< m/s, of all nodes so far
  std::vector<std::uint8_t> lies_;      ///< [nodes] on the floor
  std::vector<double> landing_speeds_;  ///< [nodes] m/s, sum over the landings
  double momentum_ = 0;                 ///< kg m/s, of all landings
};

}  // namespace

std::optional<std::size_t> first_bad_node(const State& state) {
  const auto is_single = [](const Vec3d& a) {
    constexpr double largest = std::numeric_limits<float>::max();
    return std::abs(a.x) <= largest && std::abs(a.y) <= largest && std::abs(a.z) <= largest;
  };
  for (std::size_t i = 0; i < state.position.size(); ++i)
    if (!is_single(state.position[i]) || !is_single(state.velocity[i])) return i;
  return std::nullopt;
}

bool is_in_the_air(const State& state, const Floor& floor) {
  return std::ranges::all_of(state.position, [&](const Vec3d& x) { return x.y > floor.height; });
}

std::optional<BlowUp> find_blow_up(Backend& backend, const State& from, int steps) {
  const auto bad_node_after = [&](int count) {
    backend.set_state(from);
    backend.step(count);
    return first_bad_node(backend.state());
  };
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

std::string describe(const BlowUp& blow_up, double dt_s, std::int64_t steps_before, std::string_view remedy) {
  const std::int64_t step = steps_before + blow_up.step;
  return fmt::format("blew up at step {} (t = {:.6g} s): node {} is not finite in single precision; {}", step,
                     static_cast<double>(step) * dt_s, blow_up.node, remedy);
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
  constexpr double share = 0.01, rounding = 8 * unit_roundoff;
  double rounded = 0;
  for (const Spring& spring : system.springs) {
    const Vec3d& x = state.position[spring.first];
    rounded += system.materials[spring.kind].stiffness / 2 * rounding * rounding * dot(x, x) / 3;
  }
  // Never 0, even for a scene at rest whose springs do not resist.
  return std::max({energy.kinetic + energy.elastic, rounded / share, std::numeric_limits<double>::min()});
}

Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state) {
  return {position_deviation(system, reference, state),
          (energy_of(system, state).total() - energy.total()) / energy_in_motion(system, reference, energy)};
}

int position_roundings(const Integrator& integrator) {
  if (is_implicit(integrator)) return 1;
  return static_cast<int>(std::ranges::count_if(
      integrator.stages, [](const Stage& stage) { return writes(stage, Slot::x_next); }));
}

namespace {

/// Deviation that is allowed, in deviations of a reference that is rounded once after every step: a backend
/// rounds in each of `position_roundings` stages, and other numbers besides.
double share_of_rounded(const Integrator& integrator) { return 4.0 * position_roundings(integrator); }

}  // namespace

double position_tolerance(const System& system, const Integrator& integrator, int steps) {
  return 4 * std::sqrt(static_cast<double>(steps) * position_roundings(integrator)) * unit_roundoff *
         largest_coordinate(system.start) / mean_rest_length(system);
}

int comparable_steps(const System& system, const Integrator& integrator, double dt_s, int most) {
  ModeBound modes = mode_bound(system);
  if (is_implicit(integrator) || largest_amplification(integrator, dt_s, modes) <= 1 + tolerated_growth)
    return most;
  // Gershgorin's bound on the stiffest mode is two to four times too large.
  const Spectrum spectrum = spectrum_at(system, system.start);
  modes.stiffness = spectrum.stiffness;
  modes.damping = spectrum.damping;
  const double growth = std::log(largest_amplification(integrator, dt_s, modes));
  return growth > 0 ? static_cast<int>(std::clamp<double>(std::log(2) / growth, 1, most)) : most;
}

std::string touches_at_once(int steps) {
  return "a node touches the floor within the first " + std::to_string(steps) +
         " steps, so nothing can be verified before contact; start the scene higher";
}

Reference run_reference(const System& system, const Integrator& integrator, double dt_s) {
  Reference reference;
  const auto failed = [&](const std::string& why) {
    reference.failure = why;
    return std::move(reference);
  };
  std::unique_ptr<Backend> backend;
  try {
    backend = make_reference(system, integrator, dt_s);
  } catch (const Unsupported& reason) {
    return failed(std::string("there is no double-precision reference: ") + reason.what());
  }
  reference.integrator = &integrator;
  reference.state = system.start;
  State before = system.start;
  bool in_the_air = true;
  const FloorWatch watch(system, dt_s, system.start);
  const int comparable = comparable_steps(system, integrator, dt_s, verification_steps);
  std::vector<double> step_seconds;
  // Continues after contact, because a blow-up may only appear then.
  for (int steps = 0; steps < verification_steps;) {
    // The signal stays noted, for others that run at the same time.
    if (const int signal = noted_ending_signal()) throw Interrupted{signal};
    const int most =
        std::min(steps_between_looks, (steps < comparable ? comparable : verification_steps) - steps);
    const int next = steps + (in_the_air ? watch.steps_to_look(before, steps, most) : most);
    const Stopwatch watch_of_steps;
    backend->step(next - steps);
    State state = backend->state();
    step_seconds.push_back(watch_of_steps.seconds() / (next - steps));
    if (const auto node = first_bad_node(state)) {
      const BlowUp blow_up =
          find_blow_up(*backend, before, next - steps).value_or(BlowUp{next - steps, *node});
      return failed("the double-precision reference " + describe(blow_up, dt_s, steps));
    }
    steps = next;
    in_the_air = in_the_air && is_in_the_air(state, system.floor);
    if (in_the_air && steps <= comparable) {
      reference.state = state;
      reference.steps = steps;
    }
    before = std::move(state);
  }
  // Fewer steps would not show much.
  if (const int least = std::min(steps_between_looks, comparable); reference.steps < least)
    return failed(touches_at_once(least));
  reference.tolerance = position_tolerance(system, integrator, reference.steps);
  if (reference.tolerance > largest_tolerance)
    return failed(fmt::format(
        "nothing can be verified: roundings to single precision may move a node by {:.3g} rest lengths in "
        "{}, more than {}; move the scene nearer to the origin",
        reference.tolerance, pluralize(reference.steps, "step"), largest_tolerance));
  reference.energy = energy_of(system, reference.state);
  reference.step_seconds = median(step_seconds);
  return reference;
}

State step_rounded(Backend& reference, double ahead_s, int steps) {
  constexpr double no_floor = -std::numeric_limits<double>::infinity();
  for (int step = 0; step < steps; ++step) {
    reference.step(1);
    State state = moved_ahead(reference.state(), ahead_s);
    round_to_single(state);
    move_back(state, ahead_s, no_floor);  // the reference moves it ahead again
    reference.set_state(state);
  }
  return reference.state();
}

Verification verify(Backend& backend, const System& system, const Reference& reference, double dt_s,
                    int steps_taken) {
  if (reference.failure) return {.failure = reference.failure};
  if (steps_taken != reference.steps) {
    backend.set_state(system.start);
    backend.step(reference.steps);
  }
  const State state = backend.state();
  if (first_bad_node(state)) {
    const auto blow_up = find_blow_up(backend, system.start, reference.steps);
    return {.failure = blow_up ? describe(*blow_up, dt_s) + std::string(unless_alone)
                               : std::string(finite_in_the_next)};
  }
  const Deviation deviation = deviation_from(system, reference.state, reference.energy, state);
  Verification result{deviation.position, deviation.energy, state_hash(state)};

  double tolerance = reference.tolerance, energy_allowed = energy_tolerance;
  const auto is_near = [&] { return deviation.position <= tolerance; };
  const auto has_energy = [&] { return std::abs(deviation.energy) <= energy_allowed; };
  if (!(is_near() && has_energy()) && system.nodes() <= most_nodes) {
    const auto rounded = make_reference(system, *reference.integrator, dt_s);
    const Deviation of_rounded =
        deviation_from(system, reference.state, energy_of(system, reference.state),
                       step_rounded(*rounded, reference.integrator->ahead * dt_s, reference.steps));
    const double share = share_of_rounded(*reference.integrator);
    tolerance = std::max(tolerance, std::min(share * of_rounded.position, largest_tolerance));
    energy_allowed =
        std::max(energy_allowed, std::min(share * std::abs(of_rounded.energy), largest_tolerance));
  }
  const std::string steps = pluralize(reference.steps, "step");
  if (!is_near())
    result.failure = fmt::format("position error {:.6g} of a rest length exceeds {:.6g} after {}",
                                 deviation.position, tolerance, steps);
  else if (!has_energy())
    result.failure =
        fmt::format("energy is off by {:.6g} of the energy in motion, more than {:.6g}, after {}",
                    deviation.energy, energy_allowed, steps);
  return result;
}

TimedState read_state(Backend& backend, const State& start, double steps_s) {
  TimedState read;
  const Stopwatch watch;
  read.state = backend.state();
  const double seconds = watch.seconds();
  // Many threads step a large cloth faster than its state is read.
  if (seconds <= steps_s) return read;
  double after_a_step = 0;  // the longest of three, because a busy machine delays single readings
  for (int time = 0; time < 3; ++time) {
    backend.set_state(start);
    backend.step(1);
    const Stopwatch again;
    backend.state();
    after_a_step = std::max(after_a_step, again.seconds());
  }
  read.postponed_s = seconds - after_a_step;
  return read;
}

std::string describe_postponed(int steps, double steps_s, double postponed_s) {
  return fmt::format(
      "it reports steps before they are done: it takes {:.6g} ms for {}, and then at least {:.6g} ms "
      "longer to return the state than after one step",
      1e3 * steps_s, pluralize(steps, "step"), 1e3 * postponed_s);
}

State sample_start(const System& system, std::uint32_t number) {
  constexpr double strain = 1e-3;
  std::mt19937 random(number);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 0x1p32;
  };
  const double unit = mean_rest_length(system);
  const double speed = strain * unit * std::sqrt(mode_bound(system).stiffness);
  // A wave for each direction of motion, each along its own direction.
  Vec3d k[3];
  double phase[3];
  for (int i = 0; i < 3; ++i) {
    k[i] = {between(-1, 1), between(-1, 1), between(-1, 1)};
    const double wavelength = between(8, 32) * unit;
    k[i] = 2 * std::numbers::pi / (wavelength * std::max(0.1, length(k[i]))) * k[i];
    phase[i] = between(0, 2 * std::numbers::pi);
  }
  State start = system.start;
  for (std::size_t i = 0; i < start.position.size(); ++i) {
    const Vec3d& x = start.position[i];
    start.velocity[i] += speed * Vec3d{std::sin(dot(k[0], x) + phase[0]), std::sin(dot(k[1], x) + phase[1]),
                                       std::sin(dot(k[2], x) + phase[2])};
  }
  for (const std::uint32_t pin : system.pins) start.velocity[pin] = system.start.velocity[pin];
  round_to_single(start);
  return start;
}

SampleEnd sample_end(const System& system, const State& state, int steps, std::size_t first) {
  return {steps, looked_at(state, first), energy_of(system, state).total()};
}

std::vector<std::string> check_samples(const System& system, const Integrator& integrator, double dt_s,
                                       const State& start, std::size_t first,
                                       std::span<const SampleEnd> ends) {
  std::vector<std::string> reasons(ends.size());
  if (ends.empty()) return reasons;
  CheckedWay way(system, integrator, dt_s, start);
  const double unit = mean_rest_length(system);
  for (const std::size_t i : ordered_places(ends, &SampleEnd::steps)) {
    const SampleEnd& end = ends[i];
    way.go_to(end.steps);
    const std::string after = fmt::format(" after the {} of a sample", pluralize(end.steps, "step"));
    if (first_bad_node(way.state())) {
      reasons[i] = "the double-precision reference is not finite" + after;
      continue;
    }
    const std::vector<Vec3d> expected = looked_at(way.state(), first);
    const Energy energy = energy_of(system, way.state());
    const double error = largest_distance(end.positions, expected) / unit;
    const double energy_off = end.energy_j - energy.total();
    const double landing = way.landing_distance() / unit, landing_j = way.landing_energy();
    double tolerance = position_tolerance(system, integrator, end.steps);
    double energy_allowed = energy_tolerance * energy_in_motion(system, way.state(), energy);
    const auto is_near = [&] { return error <= tolerance + landing; };
    const auto has_energy = [&] { return std::abs(energy_off) <= energy_allowed + landing_j; };
    const double share = share_of_rounded(integrator);
    // One copy may be near by chance.
    for (std::uint32_t copy = 0; copy < CheckedWay::most_copies; ++copy) {
      if ((is_near() && has_energy()) || system.nodes() > most_nodes) break;
      const State rounded = way.rounded(copy);
      tolerance = std::max(tolerance, share * largest_distance(looked_at(rounded, first), expected) / unit);
      energy_allowed =
          std::max(energy_allowed, share * std::abs(energy_of(system, rounded).total() - energy.total()));
    }
    if (!is_near())
      reasons[i] = fmt::format("position error {:.6g} of a rest length exceeds {:.6g}{}", error,
                               tolerance + landing, after);
    else if (!has_energy())
      reasons[i] = fmt::format("energy is off by {:.6g} J, more than {:.6g} J,{}", energy_off,
                               energy_allowed + landing_j, after);
  }
  return reasons;
}

EnergyLedger::EnergyLedger(const System& system, const Integrator& integrator, double dt_s)
    : system_(system),
      floorless_(without_floor(system)),
      dt_s_(dt_s),
      ahead_s_(integrator.ahead * dt_s),
      reference_(make_reference(floorless_, integrator, dt_s)),
      pinned_(system.nodes(), 0),
      touches_(system.nodes(), 0) {
  for (const std::uint32_t node : system.pins) pinned_[node] = 1;
}

void EnergyLedger::step(Backend& backend) {
  const State before = backend.state();
  State start = before;
  bool was_put_on_floor = false;  // by move_back(), from where the step starts
  for (std::size_t i = 0; ahead_s_ != 0 && i < system_.nodes(); ++i) {
    if (pinned_[i] != 0 || start.position[i].y != system_.floor.height || !(start.velocity[i].y > 0))
      continue;
    start.position[i].y -= ahead_s_ * start.velocity[i].y;
    was_put_on_floor = true;
  }
  reference_->set_state(start);
  reference_->step(1);
  const State landing = reference_->state();
  const double damping = dt_s_ / 2 * (damping_power(system_, before) + damping_power(system_, landing));
  losses_.damping += damping;
  double& rest = account_for_contact(landing) || was_put_on_floor ? losses_.bounce : losses_.integration;
  rest += energy_of(system_, before).total() - energy_of(system_, landing).total() - damping;
  backend.step(1);
}

bool EnergyLedger::account_for_contact(const State& landing) {
  const Floor& floor = system_.floor;
  State after = landing;
  bool contact = false;
  for (std::size_t i = 0; i < system_.nodes(); ++i) {
    Vec3d &x = after.position[i], &v = after.velocity[i];
    x += ahead_s_ * v;  // the position that the stages see
    touches_[i] = pinned_[i] == 0 && x.y < floor.height;
    if (touches_[i] == 0) continue;
    contact = true;
    const Vec3d falling = v;
    touch_floor(x, v, floor.height, floor.restitution, floor.friction);
    x.y = std::max(x.y - ahead_s_ * v.y, floor.height);  // as move_back() does
    x.x -= ahead_s_ * v.x;
    x.z -= ahead_s_ * v.z;
    const double mass = system_.node_mass[i], rise = x.y - landing.position[i].y;
    losses_.friction += mass / 2 * (falling.x * falling.x + falling.z * falling.z - v.x * v.x - v.z * v.z);
    losses_.bounce += mass / 2 * (falling.y * falling.y - v.y * v.y) - mass * system_.gravity * rise;
  }
  if (!contact) return false;
  for (std::size_t i = 0; ahead_s_ != 0 && i < system_.nodes(); ++i)
    if (touches_[i] == 0) after.position[i] = landing.position[i];
  for (const Spring& spring : system_.springs)
    if (touches_[spring.first] != 0 || touches_[spring.second] != 0)
      losses_.bounce += elastic_energy(system_, spring, landing) - elastic_energy(system_, spring, after);
  return true;
}

}  // namespace mssim
