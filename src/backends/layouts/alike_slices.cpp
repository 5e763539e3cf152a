#include "backends/layouts/alike_slices.h"

#include <algorithm>
#include <array>

namespace mssim {

AlikeSlices::AlikeSlices(const std::vector<AlikeBodies>& bodies, std::size_t lane_count) : lanes(lane_count) {
  for (std::size_t shape = 0; shape < bodies.size(); ++shape) {
    const std::vector<std::vector<std::uint32_t>>& all = bodies[shape].bodies;
    nodes += all.size() * bodies[shape].nodes();
    for (std::size_t first = 0; first < all.size(); first += lanes) {
      groups.push_back({shape, count});
      count += bodies[shape].nodes();
      for (std::size_t node = 0; node < bodies[shape].nodes(); ++node)
        for (std::size_t lane = 0; lane < lanes; ++lane)
          scene_node.push_back(all[first + lane < all.size() ? first + lane : first][node]);
    }
  }
}

void AlikeSlices::write(const State& state, float* pair) const {
  for (std::size_t slice = 0; slice < count; ++slice, pair += components * lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::uint32_t node = scene_node[slice * lanes + lane];
      const Vec3<float> x = vec3_cast<float>(state.position[node]),
                        v = vec3_cast<float>(state.velocity[node]);
      const std::array<float, components> values{x.x, x.y, x.z, v.x, v.y, v.z};
      for (std::size_t i = 0; i < components; ++i) pair[i * lanes + lane] = values[i];
    }
}

State AlikeSlices::read(const float* pair) const {
  State state{std::vector<Vec3d>(nodes), std::vector<Vec3d>(nodes)};
  for (std::size_t slice = 0; slice < count; ++slice, pair += components * lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::uint32_t node = scene_node[slice * lanes + lane];
      const auto value = [&](std::size_t i) { return static_cast<double>(pair[i * lanes + lane]); };
      state.position[node] = {value(0), value(1), value(2)};
      state.velocity[node] = {value(3), value(4), value(5)};
    }
  return state;
}

}  // namespace mssim
