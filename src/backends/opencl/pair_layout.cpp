#include "backends/opencl/pair_layout.h"

#include <CL/opencl.hpp>
#include <span>

namespace mssim {

void write_state(const DeviceQueue& queue, const OpenclBuffer<float>& buffer, const PairLayout& layout,
                 const State& state, std::size_t first) {
  buffer.write(queue.commands(), [&](std::span<float> memory) {
    const auto put = [&](std::size_t offset, std::size_t node) {
      const Vec3d &x = state.position[node], &v = state.velocity[node];
      const std::array values{x.x, x.y, x.z, v.x, v.y, v.z};
      for (std::size_t i = 0; i < values.size(); ++i)
        memory[first + offset + layout.component[i]] = static_cast<float>(values[i]);
    };
    for (std::size_t node = 0; node < layout.node.size(); ++node) put(layout.node[node], node);
    for (const auto& [offset, node] : layout.copies) put(offset, node);
  });
}

State read_state(const DeviceQueue& queue, const OpenclBuffer<float>& buffer, const PairLayout& layout) {
  const auto memory = buffer.map(queue.commands(), CL_MAP_READ);
  State state;
  for (const std::size_t node : layout.node) {
    const auto number = [&](std::size_t i) { return double{memory[node + layout.component[i]]}; };
    state.position.push_back({number(0), number(1), number(2)});
    state.velocity.push_back({number(3), number(4), number(5)});
  }
  buffer.unmap(queue.commands(), memory, CL_MAP_READ);
  queue.commands().finish();
  return state;
}

}  // namespace mssim
