#include "guide/independent_solver.h"

#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "laws/host_laws.h"

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

/// The derivative by time of positions and velocities.
class MotionOfNodes {
 public:
  explicit MotionOfNodes(const System& system) : system_(system), force_(system.nodes()) {}

  void operator()(const Numbers& now, Numbers& rate, double /*time_s*/) {
    const std::size_t nodes = system_.nodes();
    for (Vec3d& force : force_) force = {};
    for (const Spring& spring : system_.springs) {
      const Vec3d d = vector_at(now, spring.second) - vector_at(now, spring.first);
      const Vec3d u = vector_at(now, nodes + spring.second) - vector_at(now, nodes + spring.first);
      const SpringMaterial& material = system_.materials[spring.kind];
      const Vec3d force =
          spring_pull(dot(d, d), dot(u, d), material.stiffness,
                      material.stiffness * static_cast<double>(spring.rest_length), material.damping) *
          d;
      force_[spring.first] += force;
      force_[spring.second] -= force;
    }
    for (std::size_t node = 0; node < nodes; ++node) {
      const Vec3d v = vector_at(now, nodes + node);
      put_vector(rate, node, v);
      put_vector(rate, nodes + node,
                 node_acceleration((1 / system_.node_mass[node]) * force_[node], v, system_.viscous_damping,
                                   system_.gravity));
    }
    for (const std::uint32_t pin : system_.pins) {
      put_vector(rate, pin, {});
      put_vector(rate, nodes + pin, {});
    }
  }

 private:
  const System& system_;
  std::vector<Vec3d> force_;  // N
};

}  // namespace

std::optional<State> independent_state(const System& system, double span_s, double tolerance,
                                       const std::function<bool()>& stop) {
  const std::size_t nodes = system.nodes();
  Numbers numbers(6 * nodes);
  for (std::size_t node = 0; node < nodes; ++node) {
    put_vector(numbers, node, system.start.position[node]);
    put_vector(numbers, nodes + node, system.start.velocity[node]);
  }
  // By reference: the stepper copies what it calls.
  MotionOfNodes motion(system);
  const auto rate = [&motion](const Numbers& now, Numbers& out, double time_s) { motion(now, out, time_s); };
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
  for (const std::uint32_t pin : system.pins)  // which extrapolation rounds
    state.position[pin] = system.start.position[pin];
  return state;
}

}  // namespace mssim
