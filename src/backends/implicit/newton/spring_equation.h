#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "backends/implicit/nodes/plain_nodes.h"
#include "laws/host_laws.h"

namespace mssim {

/// Thrown by a step that was stopped.
struct GivenUp {};

/// The BackwardEulerEquation (newton_method.h) in a straightforward program: arrays of nodes, and each listed
/// spring's part of A.
template <class Real>
class SpringEquation {
 public:
  /// `system` must outlive it. Throws GivenUp if `stop`, called before each product, returns true.
  SpringEquation(const System& system, double dt_s, std::function<bool()> stop = {})
      : springs_(system.springs),
        nodes_(system),
        dt_(static_cast<Real>(dt_s)),
        slopes_(system.springs.size()),
        inverse_(system.nodes()),
        stop_(std::move(stop)) {
    for (auto* vectors : {&w_, &z_, &p_, &s_, &e_, &q_}) vectors->resize(system.nodes());
  }

  void set_state(const State& state) { nodes_.set_state(state); }
  State state() const { return nodes_.state(); }

  void begin() { w_ = nodes_.v; }
  void linearise_at_state() { linearise_springs<true>(); }
  double linearise() { return linearise_springs<false>(); }
  double start_solving() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Real inertia = nodes_.mass[i] * (1 + dt_ * nodes_.viscous_damping);
      inverse_[i] = {inertia, 0, 0, inertia, 0, inertia};
    }
    for (std::size_t i = 0; i < springs_.size(); ++i) {
      const auto& [n, along, across] = slopes_[i];
      const SymmetricBlock<Real> block = spring_jacobian(n.x, n.y, n.z, along, across);
      for (const std::uint32_t end : {springs_[i].first, springs_[i].second})
        inverse_[end] = block_sum(inverse_[end], block);
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      inverse_[i] = nodes_.pinned[i] ? SymmetricBlock<Real>{} : block_inverse(inverse_[i]);
    for (auto* vectors : {&p_, &s_}) std::fill(vectors->begin(), vectors->end(), Vec3<Real>{});
    return precondition();
  }
  double turn(double factor) {
    if (stop_ && stop_()) throw GivenUp();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      p_[i] = mul_add(static_cast<Real>(factor), p_[i], z_[i]);
      q_[i] = nodes_.mass[i] * (1 + dt_ * nodes_.viscous_damping) * p_[i];
    }
    for (std::size_t i = 0; i < springs_.size(); ++i) {
      const auto [first, second, rest_length, kind] = springs_[i];
      const auto& [n, along, across] = slopes_[i];
      const Vec3<Real> product = spring_jacobian_times(n, along, across, p_[second] - p_[first]);
      q_[first] -= product;
      q_[second] += product;
    }
    return sum_over_nodes([&](std::size_t i) { return dot(p_[i], q_[i]); });
  }
  double advance(double factor) {
    const auto step = static_cast<Real>(factor);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      s_[i] = mul_add(step, p_[i], s_[i]);
      e_[i] = mul_add(-step, q_[i], e_[i]);
    }
    return precondition();
  }
  void add(double factor) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) w_[i] = mul_add(static_cast<Real>(factor), s_[i], w_[i]);
  }
  double along_solution() const {
    return sum_over_nodes([&](std::size_t i) { return dot(e_[i], s_[i]); });
  }
  double motion() const {
    return sum_over_nodes([&](std::size_t i) { return nodes_.mass[i] * dot(w_[i], w_[i]); });
  }
  double change() const {
    return sum_over_nodes([&](std::size_t i) {
      const Vec3<Real> change = w_[i] - nodes_.v[i];
      return nodes_.mass[i] * dot(change, change);
    });
  }
  void end() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.x[i] = mul_add(dt_, w_[i], nodes_.x[i]);
    std::swap(nodes_.v, w_);
    nodes_.touch_floor();
  }

 private:
  /// A spring's part of A: along n n^T + across (I - n n^T), kg.
  struct SpringSlope {
    Vec3<Real> n;
    Real along, across;
  };

  template <bool at_state>
  double linearise_springs() {
    std::fill(e_.begin(), e_.end(), Vec3<Real>{});
    for (std::size_t i = 0; i < springs_.size(); ++i) {
      const Spring& spring = springs_[i];
      const auto law = linear_spring(nodes_.materials[spring.kind], static_cast<Real>(spring.rest_length));
      const Vec3<Real> u = w_[spring.second] - w_[spring.first];
      Vec3<Real> d = nodes_.x[spring.second] - nodes_.x[spring.first];
      // Not the difference of x + dt w, whose rounding would lose most digits of a small stretch.
      if constexpr (!at_state) d += dt_ * u;
      const Real inverse_length = inverse_sqrt(dot(d, d));
      const Vec3<Real> n = inverse_length * d;
      const Real across = spring_across_definite(inverse_length, law);
      Vec3<Real> force = spring_pull_at(inverse_length, dot(u, d), law) * d;
      if constexpr (at_state) force += dt_ * spring_jacobian_times(n, spring_along(law), across, u);
      e_[spring.first] += force;
      e_[spring.second] -= force;
      slopes_[i] = {n, spring_step_along(dt_, law.constants), dt_ * dt_ * across};
    }
    double norm = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_.pinned[i]) continue;
      const Real mass = nodes_.mass[i];
      const Vec3<Real> a = node_acceleration(1 / mass * e_[i], w_[i], nodes_.viscous_damping, nodes_.gravity);
      const Vec3<Real> missing = dt_ * a - (w_[i] - nodes_.v[i]);
      e_[i] = mass * missing;
      norm += static_cast<double>(dot(e_[i], missing));
    }
    return norm;
  }
  /// z = P e. Returns e . z.
  double precondition() {
    return sum_over_nodes([&](std::size_t i) {
      z_[i] = block_times(inverse_[i], e_[i]);
      return dot(e_[i], z_[i]);
    });
  }
  /// The sum of value(node), node by node.
  template <class Value>
  double sum_over_nodes(Value value) const {
    double sum = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) sum += static_cast<double>(value(i));
    return sum;
  }

  const std::vector<Spring>& springs_;
  PlainNodes<Real> nodes_;
  Real dt_;
  std::vector<SpringSlope> slopes_;            ///< [springs]
  std::vector<SymmetricBlock<Real>> inverse_;  ///< [nodes] P, 1/kg; zero if pinned, so z, p and s are too
  std::vector<Vec3<Real>> w_, z_, p_, s_;      ///< [nodes] m/s
  std::vector<Vec3<Real>> e_, q_;              ///< [nodes] N s
  std::function<bool()> stop_;
};

}  // namespace mssim
