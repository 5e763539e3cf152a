#include "backends/implicit/constraints/compliance.h"
#include "backends/implicit/constraints/constraints.h"
#include "backends/implicit/constraints/spring_order.h"
#include "backends/implicit/nodes/plain_nodes.h"

namespace mssim {
namespace {

#define MSSIM_INLINE inline
#include "backends/implicit/constraints/carried_sum-inl.h"
#undef MSSIM_INLINE

template <class Real>
class SerialConstraints final : public Backend {
 public:
  SerialConstraints(const System& system, double dt_s)
      : nodes_(system),
        rest_(system.nodes()),
        substeps_(system.solver.substeps),
        h_(static_cast<Real>(dt_s / system.solver.substeps)) {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      mobility_.push_back(nodes_.pinned[i] ? Real{} : static_cast<Real>(1 / system.node_mass[i]));
    const double h_s = dt_s / system.solver.substeps;
    springs_.reserve(system.springs.size());
    for (const Spring& spring : spring_order(system).springs)
      springs_.push_back({spring.first, spring.second,
                          Compliance<Real>(system.materials[spring.kind], spring.rest_length, h_s,
                                           static_cast<double>(mobility_[spring.first]) +
                                               static_cast<double>(mobility_[spring.second]))});
  }

  void set_state(const State& state) override {
    nodes_.set_state(state);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      rest_[i] = vec3_cast<Real>(state.position[i] - vec3_cast<double>(nodes_.x[i]));
  }
  State state() const override {
    State state = nodes_.state();
    for (std::size_t i = 0; i < nodes_.size(); ++i) state.position[i] += vec3_cast<double>(rest_[i]);
    return state;
  }
  std::string device() const override { return "cpu"; }
  int threads() const override { return 1; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      for (std::uint32_t substep = 0; substep < substeps_; ++substep) {
        fall();
        for (const CompliantSpring& spring : springs_) project(spring);
        for (std::size_t i = 0; i < nodes_.size(); ++i) carry_sum(nodes_.x[i], rest_[i], h_, nodes_.v[i]);
      }
      touch_floor();
    }
  }

 private:
  struct CompliantSpring {
    std::uint32_t first, second;
    Compliance<Real> compliance;
  };

  /// Gravity and the damping of the air, of a small step: v becomes (v - h g) / (1 + h c).
  void fall() {
    const Real kept = 1 / (1 + h_ * nodes_.viscous_damping);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_.pinned[i]) continue;
      Vec3<Real>& v = nodes_.v[i];
      v.y -= h_ * nodes_.gravity;
      v = kept * v;
    }
  }

  void touch_floor() {
    nodes_.touch_floor();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!(nodes_.x[i].y > nodes_.floor_height)) rest_[i].y = 0;
  }

  void project(const CompliantSpring& spring) {
    Vec3<Real>&v1 = nodes_.v[spring.first], &v2 = nodes_.v[spring.second];
    const Vec3<Real> u = v2 - v1;
    const Vec3<Real> d = nodes_.x[spring.second] - nodes_.x[spring.first] + h_ * u;
    const Compliance<Real>& c = spring.compliance;
    const Vec3<Real> impulse =
        spring_pull(dot(d, d), dot(u, d), c.stiffness, c.stiffness_rest, c.damping) * d;
    v1 += mobility_[spring.first] * impulse;
    v2 -= mobility_[spring.second] * impulse;
  }

  PlainNodes<Real> nodes_;
  std::vector<Vec3<Real>> rest_;          // [nodes] m, what their x lacks
  std::vector<Real> mobility_;            // [nodes] 1/kg, 0 where pinned
  std::vector<CompliantSpring> springs_;  // in the order of the method
  const std::uint32_t substeps_;
  const Real h_;  // s, the small step
};

}  // namespace

std::unique_ptr<Backend> make_serial_constraints(const System& system, double dt_s) {
  return std::make_unique<SerialConstraints<float>>(system, dt_s);
}

std::unique_ptr<Backend> make_constraints_reference(const System& system, double dt_s) {
  return std::make_unique<SerialConstraints<double>>(system, dt_s);
}

}  // namespace mssim
