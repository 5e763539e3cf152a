#include "bench/verification/sample_check.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <sstream>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "model/energy.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::size_t most_nodes = 1U << 20U;

/// From one node that is looked at to the next.
std::size_t stride_of(std::size_t nodes) { return (nodes + most_nodes - 1) / most_nodes; }

/// Those of the nodes that are looked at.
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

/// The reference, and where roundings alone lead beside it.
class CheckedWay {
 public:
  CheckedWay(const System& system, const Integrator& integrator, double dt_s, const State& start,
             bool with_rounded)
      : system_(system), reference_(make_reference(system, integrator, dt_s)), present_(start) {
    reference_->set_state(start);
    if (!with_rounded) return;
    rounded_ = make_reference(system, integrator, dt_s);
    rounded_->set_state(start);
  }

  void go_to(int steps) {
    constexpr int stride = 10;  // between two looks at the floor
    while (steps_ < steps) {
      const int count = std::min(stride, steps - steps_);
      reference_->step(count);
      for (int step = 0; rounded_ && step < count; ++step) {
        rounded_->step(1);
        State state = rounded_->state();
        round_to_single(state);
        rounded_->set_state(state);
      }
      steps_ += count;
      present_ = reference_->state();
      for (std::size_t i = 0; i < present_.position.size(); ++i) {
        met_floor_ = met_floor_ || present_.position[i].y <= system_.floor.height;
        fastest_ = std::max(fastest_, length(present_.velocity[i]));
      }
    }
  }

  const State& state() const { return present_; }
  bool met_floor() const { return met_floor_; }
  double fastest() const { return fastest_; }  ///< m/s, of all nodes on the way
  std::unique_ptr<State> rounded() const {
    return rounded_ ? std::make_unique<State>(rounded_->state()) : nullptr;
  }

 private:
  const System& system_;
  std::unique_ptr<Backend> reference_, rounded_;
  State present_;
  int steps_ = 0;
  bool met_floor_ = false;
  double fastest_ = 0;
};

}  // namespace

State sample_start(const System& system, std::uint32_t number) {
  constexpr double strain = 1e-3;
  std::mt19937 random(number);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 0x1p32;
  };
  const double unit = mean_rest_length(system);
  const double speed = strain * unit * std::sqrt(stiffness_bound(system).stiffness);
  // A wave for each direction of motion, each along a direction of its own.
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
  std::vector<std::size_t> order(ends.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return ends[i].steps; });
  CheckedWay way(system, integrator, dt_s, start, system.nodes() <= most_nodes);
  const double unit = mean_rest_length(system);
  for (const std::size_t i : order) {
    const SampleEnd& end = ends[i];
    way.go_to(end.steps);
    std::ostringstream why;
    const std::string after =
        " after the " + pluralize(static_cast<std::uint64_t>(end.steps), "step") + " of a sample";
    if (first_bad_node(way.state())) {
      reasons[i] = "the double-precision reference is not finite" + after;
      continue;
    }
    const std::vector<Vec3d> expected = looked_at(way.state(), first);
    const Energy energy = energy_of(system, way.state());
    double tolerance = position_tolerance(system, integrator, end.steps);
    double energy_allowed = energy_tolerance * energy_in_motion(system, way.state(), energy);
    if (const std::unique_ptr<State> rounded = way.rounded()) {
      const double share = 4.0 * position_roundings(integrator);
      tolerance = std::max(tolerance, share * largest_distance(looked_at(*rounded, first), expected) / unit);
      energy_allowed =
          std::max(energy_allowed, share * std::abs(energy_of(system, *rounded).total() - energy.total()));
    }
    if (way.met_floor()) tolerance += 4 * way.fastest() * dt_s / unit;
    const double error = largest_distance(end.positions, expected) / unit;
    const double energy_off = end.energy_j - energy.total();
    if (!(error <= tolerance))
      why << "position error " << error << " of a rest length exceeds " << tolerance << after;
    else if (!(std::abs(energy_off) <= energy_allowed))
      why << "energy is off by " << energy_off << " J, more than " << energy_allowed << " J," << after;
    reasons[i] = why.str();
  }
  return reasons;
}

}  // namespace mssim
