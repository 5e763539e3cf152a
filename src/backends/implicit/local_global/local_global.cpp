#include <algorithm>
#include <utility>

#include "backends/implicit/local_global/step_local_global.h"
#include "backends/implicit/nodes/plain_nodes.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"

namespace mssim {
namespace {

template <class Real>
class LocalGlobalSerial final : public Backend {
 public:
  LocalGlobalSerial(const System& system, double dt_s)
      : system_(system), nodes_(system), dt_(static_cast<Real>(dt_s)), force_(system.nodes()) {
    const StepMatrix matrix(system, dt_s);
    ColumnFactor factor = factorise(matrix);
    for (const std::uint32_t row : factor.order) node_.push_back(matrix.node[row]);
    first_ = std::move(factor.first);
    place_ = std::move(factor.place);
    for (const double value : factor.value) value_.push_back(static_cast<Real>(value));
    solution_.resize(node_.size());
  }

  void set_state(const State& state) override { nodes_.set_state(state); }
  State state() const override { return nodes_.state(); }
  int threads() const override { return 1; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      w_ = nodes_.v;
      for (std::uint32_t i = 0; i < system_.solver.iterations; ++i) {
        add_up_forces();
        correct_velocities();
      }
      for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.x[i] += dt_ * w_[i];
      nodes_.v = w_;
      nodes_.touch_floor();
    }
  }

 private:
  /// The local step: the springs' forces at (x + dt w, w), N.
  void add_up_forces() {
    force_.assign(nodes_.size(), {});
    for (const Spring& spring : system_.springs) {
      const Vec3<Real> u = w_[spring.second] - w_[spring.first];
      const Vec3<Real> d = nodes_.x[spring.second] - nodes_.x[spring.first] + dt_ * u;
      const auto law = linear_spring(nodes_.materials[spring.kind], static_cast<Real>(spring.rest_length));
      const Vec3<Real> force = spring_pull(dot(d, d), dot(u, d), law) * d;
      force_[spring.first] += force;
      force_[spring.second] -= force;
    }
  }

  /// The residual of m (w - v) = dt F, N s.
  Vec3<Real> residual(std::size_t node) const {
    const Vec3<Real> a = node_acceleration((1 / nodes_.mass[node]) * force_[node], w_[node],
                                           nodes_.viscous_damping, nodes_.gravity);
    return nodes_.mass[node] * (dt_ * a - (w_[node] - nodes_.v[node]));
  }

  /// The global step: w += s, where A s is the residual, for all three coordinates, by the columns of the
  /// factor.
  void correct_velocities() {
    const std::size_t rows = node_.size();
    for (std::size_t i = 0; i < rows; ++i) solution_[i] = residual(node_[i]);
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
    for (std::size_t i = 0; i < rows; ++i) w_[node_[i]] += solution_[i];
  }

  const System& system_;
  PlainNodes<Real> nodes_;
  const Real dt_;
  std::vector<Vec3<Real>> w_;      ///< [nodes] m/s, the velocities sought
  std::vector<Vec3<Real>> force_;  ///< [nodes] N

  std::vector<std::uint32_t> node_;   ///< [rows] the node at each place of the factor
  std::vector<std::size_t> first_;    ///< ColumnFactor::first
  std::vector<std::uint32_t> place_;  ///< ColumnFactor::place
  std::vector<Real> value_;           ///< ColumnFactor::value
  std::vector<Vec3<Real>> solution_;  ///< [rows] by place
};

/// Subtrees per thread, enough to balance their costs.
constexpr std::size_t subtrees_per_thread = 8;

/// Start positions of a matrix's rows, m.
std::vector<Vec3d> places_of(const System& system, const StepMatrix& matrix) {
  std::vector<Vec3d> places;
  places.reserve(matrix.rows());
  for (const std::uint32_t node : matrix.node) places.push_back(system.start.position[node]);
  return places;
}

}  // namespace

FrontSchedule::FrontSchedule(const BlockFactor& factor, std::size_t threads) {
  const auto& parts = factor.fronts.parts;
  const std::size_t count = parts.size();
  // [parts] the subtree below each part: parts from `first` to itself.
  std::vector<std::size_t> cost(count), first(count);
  std::size_t all = 0;
  for (std::size_t part = 0; part < count; ++part) {
    const auto children = factor.fronts.children.of(part);
    cost[part] += factor.cost(part);
    first[part] = children.empty() ? part : first[children.front()];
    all += factor.cost(part);
    if (parts[part].parent != Dissection::no_part) cost[parts[part].parent] += cost[part];
  }
  // A single thread needs no synchronisation: it takes everything at once.
  const std::size_t most = threads == 1 ? all : all / (threads * subtrees_per_thread);

  std::vector<std::size_t> phase(count);  // 0: within a subtree that is one item
  std::vector<std::vector<IndexRange>> items(1);
  for (std::size_t part = 0; part < count; ++part) {
    const bool is_top = parts[part].parent == Dissection::no_part || cost[parts[part].parent] > most;
    if (cost[part] <= most) {
      if (is_top) items[0].push_back({first[part], part + 1});
      continue;
    }
    for (const std::uint32_t child : factor.fronts.children.of(part))
      phase[part] = std::max(phase[part], phase[child]);
    ++phase[part];
    if (phase[part] == items.size()) items.emplace_back();
    items[phase[part]].push_back({part, part + 1});
  }
  for (std::vector<IndexRange>& of_phase : items) {
    const auto item_cost = [&](const IndexRange& item) {
      return item.end - item.begin == 1 ? factor.cost(item.begin) : cost[item.end - 1];
    };
    // The most expensive first, each to the least loaded thread; then in order again.
    std::ranges::stable_sort(of_phase, std::ranges::greater{}, item_cost);
    std::vector<std::vector<IndexRange>> shares(threads);
    std::vector<std::size_t> load(threads);
    for (const IndexRange& item : of_phase) {
      const auto thread = static_cast<std::size_t>(std::ranges::min_element(load) - load.begin());
      shares[thread].push_back(item);
      load[thread] += item_cost(item);
    }
    for (std::vector<IndexRange>& share : shares) std::ranges::sort(share, {}, &IndexRange::begin);
    phases.push_back(std::move(shares));
  }
}

template <class Nodes>
LocalGlobalNodes<Nodes>::LocalGlobalNodes(const System& system, const StepMatrix& matrix, double dt_s,
                                          std::size_t lanes, std::size_t thread_count)
    : nodes(system, lanes),
      factor(matrix, places_of(system, matrix), lanes),
      threads(threads_for(nodes.chunks.size(), thread_count)),
      schedule(factor, threads),
      dt(static_cast<float>(dt_s)),
      iterations(system.solver.iterations),
      fronts(factor.front_floats) {
  for (const std::uint32_t row : factor.fronts.order) {
    const std::uint32_t node = matrix.node[row];
    places.push_back({nodes.offset(node), static_cast<float>(system.node_mass[node])});
  }
  for (AlignedArray* field : {&x, &v, &y, &w, &e}) *field = AlignedArray(nodes.field_floats());
}

template struct LocalGlobalNodes<NodeRows>;
template struct LocalGlobalNodes<NodeSlices>;

std::unique_ptr<Backend> make_serial_local_global(const System& system, const Integrator& /*integrator*/,
                                                  double dt_s, const ExecutionOptions& /*options*/) {
  return std::make_unique<LocalGlobalSerial<float>>(system, dt_s);
}

std::unique_ptr<Backend> make_local_global_reference(const System& system, const Integrator& /*integrator*/,
                                                     double dt_s, const std::function<bool()>& /*stop*/) {
  return std::make_unique<LocalGlobalSerial<double>>(system, dt_s);
}

std::unique_ptr<Backend> make_openmp_local_global(const System& system, const Integrator& /*integrator*/,
                                                  double dt_s, const ExecutionOptions& options) {
  return make_vector_backend<LocalGlobalNodes<NodeRows>, LocalGlobalNodes<NodeSlices>>(system, dt_s, options);
}

}  // namespace mssim
