#include <utility>

#include "backends/implicit/local_global/step_fronts.h"
#include "backends/implicit/nodes/node_fields.h"

namespace mssim {
namespace {

BlockFactor factor_of(const System& system, const StepMatrix& matrix, std::size_t lanes) {
  std::vector<Vec3d> places;
  places.reserve(matrix.rows());
  for (const std::uint32_t node : matrix.node) places.push_back(system.start.position[node]);
  return {matrix, places, lanes};
}

}  // namespace

template <class Nodes>
LocalGlobalNodes<Nodes>::LocalGlobalNodes(const System& system, double dt_s, Nodes system_nodes,
                                          std::size_t lanes, std::size_t thread_count)
    : nodes(std::move(system_nodes)),
      factor(factor_of(system, {system, dt_s}, lanes)),
      threads(thread_count),
      schedule(factor, threads),
      dt(static_cast<float>(dt_s)),
      iterations(system.solver.iterations),
      fronts(factor.front_floats) {
  const StepMatrix matrix(system, dt_s);
  for (const std::uint32_t row : factor.order) {
    const std::uint32_t node = matrix.node[row];
    places.push_back({nodes.offset(node), static_cast<float>(system.node_mass[node])});
  }
  for (AlignedArray* field : {&x, &v, &y, &w, &e}) *field = AlignedArray(nodes.field_floats());
  set_state(system.start);
}

template <class Nodes>
void LocalGlobalNodes<Nodes>::set_state(const State& state) {
  write_field(nodes, state.position, x.data());
  write_field(nodes, state.velocity, v.data());
}

template <class Nodes>
State LocalGlobalNodes<Nodes>::state() const {
  return {.position = read_field(nodes, x.data()), .velocity = read_field(nodes, v.data())};
}

template struct LocalGlobalNodes<NodeRows>;
template struct LocalGlobalNodes<NodeSlices>;

}  // namespace mssim
