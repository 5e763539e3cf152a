#include "backends/sliced_graph/sliced_bodies.h"

#include <algorithm>

namespace mssim {
namespace {

/// What a slice costs beside its entries, in entries.
constexpr std::size_t slice_cost = 4;

/// Cuts the slices into `count` ranges of about the same number of entries.
std::vector<SlicedBodies::Part> balanced_parts(const SlicedGraph& graph, std::size_t count) {
  const auto cost_before = [&](std::size_t slice) { return graph.first_entry[slice] + slice * slice_cost; };
  std::vector<SlicedBodies::Part> parts;
  std::size_t slice = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t begin = slice, target = cost_before(graph.slices()) * (p + 1) / count;
    while (slice < graph.slices() && cost_before(slice + 1) <= target) ++slice;
    parts.push_back({begin, slice});
  }
  return parts;
}

}  // namespace

SlicedBodies::SlicedBodies(const System& system, const Integrator& method, double dt_s, std::size_t lanes,
                           std::size_t threads)
    : graph(system, lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      viscous_damping(static_cast<float>(system.viscous_damping)),
      gravity(static_cast<float>(system.gravity)),
      floor_height(static_cast<float>(system.floor.height)),
      restitution(static_cast<float>(system.floor.restitution)),
      friction(static_cast<float>(system.floor.friction)),
      parts(balanced_parts(graph,
                           std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(1, graph.slices())))) {
  for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
    if (!stores(method, static_cast<Pair>(pair), Storage::separate)) continue;
    pairs[pair] = AlignedArray(graph.places() * record_floats);
    base[pair] = pairs[pair].data();
  }
}

void SlicedBodies::set_state(const State& state) {
  for (std::size_t node = 0; node < graph.nodes(); ++node) {
    float* record = base[index(Pair::state)] + graph.place[node] * record_floats;
    const Vec3<float> x = vec3_cast<float>(state.position[node]), v = vec3_cast<float>(state.velocity[node]);
    const std::array<float, record_floats> values{x.x, x.y, x.z, 0, v.x, v.y, v.z, 0};
    std::copy(values.begin(), values.end(), record);
  }
}

State SlicedBodies::state() const {
  State state;
  for (std::size_t node = 0; node < graph.nodes(); ++node) {
    const float* record = base[index(Pair::state)] + graph.place[node] * record_floats;
    state.position.push_back(vec3_cast<double>(Vec3<float>{record[0], record[1], record[2]}));
    state.velocity.push_back(vec3_cast<double>(Vec3<float>{record[4], record[5], record[6]}));
  }
  return state;
}

}  // namespace mssim
