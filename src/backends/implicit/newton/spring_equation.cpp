#include "backends/implicit/newton/spring_equation.h"

#include <algorithm>
#include <utility>

#include "laws/host_laws.h"

namespace mssim {

template <class Real>
SpringEquation<Real>::SpringEquation(const System& system, double dt_s)
    : springs_(system.springs),
      nodes_(system),
      dt_(static_cast<Real>(dt_s)),
      slopes_(system.springs.size()),
      inverse_(system.nodes()) {
  for (const SpringMaterial& material : system.materials)
    materials_.push_back({static_cast<Real>(material.stiffness), static_cast<Real>(material.damping)});
  for (auto* vectors : {&w_, &z_, &p_, &s_, &e_, &q_}) vectors->resize(system.nodes());
}

template <class Real>
void SpringEquation<Real>::begin() {
  w_ = nodes_.v;
}

template <class Real>
void SpringEquation<Real>::linearise_at_state() {
  linearise_springs<true>();
}

template <class Real>
double SpringEquation<Real>::linearise() {
  return linearise_springs<false>();
}

template <class Real>
template <bool at_state>
double SpringEquation<Real>::linearise_springs() {
  std::fill(e_.begin(), e_.end(), Vec3<Real>{});
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Spring& spring = springs_[i];
    const auto [stiffness, damping] = materials_[spring.kind];
    const Real stiffness_rest = stiffness * static_cast<Real>(spring.rest_length);
    const Vec3<Real> u = w_[spring.second] - w_[spring.first];
    Vec3<Real> d = nodes_.x[spring.second] - nodes_.x[spring.first];
    // Not the difference of x + dt w: rounding these would cost most digits of a small stretch.
    if constexpr (!at_state) d += dt_ * u;
    const Real inverse_length = inverse_sqrt(dot(d, d));
    const Vec3<Real> n = inverse_length * d;
    const Real across = spring_across_definite(inverse_length, stiffness, stiffness_rest);
    Vec3<Real> force = spring_pull_at(inverse_length, dot(u, d), stiffness, stiffness_rest, damping) * d;
    if constexpr (at_state) force += dt_ * spring_jacobian_times(n, stiffness, across, u);
    e_[spring.first] += force;
    e_[spring.second] -= force;
    slopes_[i] = {n, dt_ * (damping + dt_ * stiffness), dt_ * dt_ * across};
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

template <class Real>
double SpringEquation<Real>::start_solving() {
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

template <class Real>
double SpringEquation<Real>::turn(double factor) {
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
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) sum += static_cast<double>(dot(p_[i], q_[i]));
  return sum;
}

template <class Real>
double SpringEquation<Real>::advance(double factor) {
  const auto step = static_cast<Real>(factor);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    s_[i] = mul_add(step, p_[i], s_[i]);
    e_[i] = mul_add(-step, q_[i], e_[i]);
  }
  return precondition();
}

template <class Real>
double SpringEquation<Real>::precondition() {
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    z_[i] = block_times(inverse_[i], e_[i]);
    sum += static_cast<double>(dot(e_[i], z_[i]));
  }
  return sum;
}

template <class Real>
void SpringEquation<Real>::add(double factor) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) w_[i] = mul_add(static_cast<Real>(factor), s_[i], w_[i]);
}

template <class Real>
double SpringEquation<Real>::along_solution() const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) sum += static_cast<double>(dot(e_[i], s_[i]));
  return sum;
}

template <class Real>
double SpringEquation<Real>::motion() const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    sum += static_cast<double>(nodes_.mass[i] * dot(w_[i], w_[i]));
  return sum;
}

template <class Real>
double SpringEquation<Real>::change() const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vec3<Real> change = w_[i] - nodes_.v[i];
    sum += static_cast<double>(nodes_.mass[i] * dot(change, change));
  }
  return sum;
}

template <class Real>
void SpringEquation<Real>::end() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.x[i] = mul_add(dt_, w_[i], nodes_.x[i]);
  std::swap(nodes_.v, w_);
  nodes_.touch_floor();
}

template class SpringEquation<float>;
template class SpringEquation<double>;

}  // namespace mssim
