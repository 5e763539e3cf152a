#include "backends/implicit/newton/newton.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "backends/implicit/newton/newton_method.h"
#include "backends/implicit/newton/step_newton.h"
#include "backends/vectors/step_kernels.h"
#include "laws/host_laws.h"

namespace mssim {

template <class Real>
SpringEquation<Real>::SpringEquation(const System& system, double dt_s)
    : springs_(system.springs),
      nodes_(system),
      dt_(static_cast<Real>(dt_s)),
      slopes_(system.springs.size()),
      inverse_(system.nodes()) {
  for (auto* vectors : {&w_, &z_, &p_, &s_, &e_, &q_}) vectors->resize(system.nodes());
}

template <class Real>
template <bool at_state>
double SpringEquation<Real>::linearise_springs() {
  std::fill(e_.begin(), e_.end(), Vec3<Real>{});
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Spring& spring = springs_[i];
    const auto [stiffness, damping] = nodes_.materials[spring.kind];
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
  return sum_over_nodes([&](std::size_t i) { return dot(p_[i], q_[i]); });
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
  return sum_over_nodes([&](std::size_t i) {
    z_[i] = block_times(inverse_[i], e_[i]);
    return dot(e_[i], z_[i]);
  });
}

template <class Real>
void SpringEquation<Real>::add(double factor) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) w_[i] = mul_add(static_cast<Real>(factor), s_[i], w_[i]);
}

template <class Real>
double SpringEquation<Real>::along_solution() const {
  return sum_over_nodes([&](std::size_t i) { return dot(e_[i], s_[i]); });
}

template <class Real>
double SpringEquation<Real>::motion() const {
  return sum_over_nodes([&](std::size_t i) { return nodes_.mass[i] * dot(w_[i], w_[i]); });
}

template <class Real>
double SpringEquation<Real>::change() const {
  return sum_over_nodes([&](std::size_t i) {
    const Vec3<Real> change = w_[i] - nodes_.v[i];
    return nodes_.mass[i] * dot(change, change);
  });
}

template <class Real>
void SpringEquation<Real>::end() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.x[i] = mul_add(dt_, w_[i], nodes_.x[i]);
  std::swap(nodes_.v, w_);
  nodes_.touch_floor();
}

template class SpringEquation<float>;
template class SpringEquation<double>;

namespace {

/// What a step ends with that nobody waits for any longer.
struct GivenUp {};

/// An equation whose solver asks before each product whether anybody waits for it still.
template <class Real>
class AwaitedEquation : public SpringEquation<Real> {
 public:
  AwaitedEquation(const System& system, double dt_s, std::function<bool()> stop)
      : SpringEquation<Real>(system, dt_s), stop_(std::move(stop)) {}
  double turn(double factor) {
    if (stop_ && stop_()) throw GivenUp();
    return SpringEquation<Real>::turn(factor);
  }

 private:
  std::function<bool()> stop_;
};

template <class Real>
class NewtonSerial final : public Backend {
 public:
  NewtonSerial(const System& system, const Integrator& integrator, double dt_s, double tolerance,
               std::function<bool()> stop = {})
      : equation_(system, dt_s, std::move(stop)),
        integrator_(integrator),
        goal_(solver_goal<Real>(system, dt_s, tolerance)) {}

  void set_state(const State& state) override { equation_.set_state(state); }
  State state() const override { return equation_.state(); }
  std::string device() const override { return "cpu"; }
  int threads() const override { return 1; }
  std::string note() const override { return note_of(work_); }

  void step(int count) override {
    try {
      for (int step = 0; step < count; ++step) take_step(equation_, integrator_, goal_, work_);
    } catch (const GivenUp&) {
      // Who gave it up knows.
    }
  }

 private:
  AwaitedEquation<Real> equation_;
  const Integrator& integrator_;
  const SolverGoal goal_;
  SolverWork work_;
};

/// Part of the norms at which the reference's solvers end, beside which a step's own error is large.
constexpr double reference_tolerance = 1e-12;

}  // namespace

std::unique_ptr<Backend> make_serial_newton(const System& system, const Integrator& integrator, double dt_s) {
  return std::make_unique<NewtonSerial<float>>(system, integrator, dt_s, system.solver.tolerance);
}

std::unique_ptr<Backend> make_newton_reference(const System& system, const Integrator& integrator,
                                               double dt_s, const std::function<bool()>& stop) {
  return std::make_unique<NewtonSerial<double>>(system, integrator, dt_s, reference_tolerance, stop);
}

std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return make_vector_backend<VectorEquation<NodeRows>, VectorEquation<NodeSlices>>(system, dt_s, options,
                                                                                   integrator);
}

}  // namespace mssim
