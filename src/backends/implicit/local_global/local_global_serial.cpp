#include <utility>

#include "backends/implicit/local_global/factorise.h"
#include "backends/implicit/local_global/local_global.h"
#include "backends/implicit/nodes/plain_nodes.h"

namespace mssim {
namespace {

/// Solves A s = e for the three coordinates at once, by the columns of the factor.
template <class Real>
class ColumnSolver {
 public:
  explicit ColumnSolver(ColumnFactor factor)
      : order_(std::move(factor.order)), first_(std::move(factor.first)), place_(std::move(factor.place)) {
    for (const double value : factor.value) value_.push_back(static_cast<Real>(value));
    solution_.resize(order_.size());
  }

  /// act(row, s of the row) for all rows. `right(row)` is its e.
  template <class Right, class Act>
  void solve(Right&& right, Act&& act) {
    const std::size_t rows = order_.size();
    for (std::size_t i = 0; i < rows; ++i) solution_[i] = right(order_[i]);
    for (std::size_t i = 0; i < rows; ++i) {
      const std::size_t diagonal = first_[i];
      const Vec3<Real> s = solution_[i] = (1 / value_[diagonal]) * solution_[i];
      for (std::size_t k = diagonal + 1; k < first_[i + 1]; ++k) solution_[place_[k]] -= value_[k] * s;
    }
    for (std::size_t i = rows; i-- > 0;) {
      const std::size_t diagonal = first_[i];
      Vec3<Real> s = solution_[i];
      for (std::size_t k = diagonal + 1; k < first_[i + 1]; ++k) s -= value_[k] * solution_[place_[k]];
      solution_[i] = (1 / value_[diagonal]) * s;
    }
    for (std::size_t i = 0; i < rows; ++i) act(order_[i], solution_[i]);
  }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> place_;
  std::vector<Real> value_;
  std::vector<Vec3<Real>> solution_;  ///< [rows]
};

template <class Real>
class LocalGlobalSerial final : public Backend {
 public:
  LocalGlobalSerial(const System& system, double dt_s) : LocalGlobalSerial(system, dt_s, {system, dt_s}) {}

  void set_state(const State& state) override { nodes_.set_state(state); }
  State state() const override { return nodes_.state(); }
  std::string device() const override { return "cpu"; }
  int threads() const override { return 1; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      w_ = nodes_.v;
      for (std::uint32_t i = 0; i < system_.solver.iterations; ++i) {
        add_up_forces();
        solver_.solve([&](std::uint32_t row) { return residual(row_node_[row]); },
                      [&](std::uint32_t row, const Vec3<Real>& s) { w_[row_node_[row]] += s; });
      }
      for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.x[i] += dt_ * w_[i];
      nodes_.v = w_;
      nodes_.touch_floor();
    }
  }

 private:
  struct Material {
    Real stiffness, damping;
  };

  LocalGlobalSerial(const System& system, double dt_s, const StepMatrix& matrix)
      : system_(system),
        nodes_(system),
        dt_(static_cast<Real>(dt_s)),
        row_node_(matrix.node),
        solver_(factorise(matrix)),
        force_(system.nodes()) {
    for (const SpringMaterial& material : system.materials)
      materials_.push_back({static_cast<Real>(material.stiffness), static_cast<Real>(material.damping)});
  }

  /// The local step: the springs' forces at (x + dt w, w), N.
  void add_up_forces() {
    force_.assign(nodes_.size(), {});
    for (const Spring& spring : system_.springs) {
      const Vec3<Real> u = w_[spring.second] - w_[spring.first];
      const Vec3<Real> d = nodes_.x[spring.second] - nodes_.x[spring.first] + dt_ * u;
      const Material& material = materials_[spring.kind];
      const Vec3<Real> force =
          spring_pull(dot(d, d), dot(u, d), material.stiffness,
                      material.stiffness * static_cast<Real>(spring.rest_length), material.damping) *
          d;
      force_[spring.first] += force;
      force_[spring.second] -= force;
    }
  }

  /// What is missing for m (w - v) = dt F, N s.
  Vec3<Real> residual(std::size_t node) const {
    const Vec3<Real> a = node_acceleration((1 / nodes_.mass[node]) * force_[node], w_[node],
                                           nodes_.viscous_damping, nodes_.gravity);
    return nodes_.mass[node] * (dt_ * a - (w_[node] - nodes_.v[node]));
  }

  const System& system_;
  PlainNodes<Real> nodes_;
  const Real dt_;
  const std::vector<std::uint32_t> row_node_;  ///< [rows] StepMatrix::node
  ColumnSolver<Real> solver_;
  std::vector<Material> materials_;
  std::vector<Vec3<Real>> w_;      ///< [nodes] m/s, the velocities sought
  std::vector<Vec3<Real>> force_;  ///< [nodes] N
};

}  // namespace

std::unique_ptr<Backend> make_serial_local_global(const System& system, double dt_s) {
  return std::make_unique<LocalGlobalSerial<float>>(system, dt_s);
}

std::unique_ptr<Backend> make_local_global_reference(const System& system, double dt_s) {
  return std::make_unique<LocalGlobalSerial<double>>(system, dt_s);
}

}  // namespace mssim
