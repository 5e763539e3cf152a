#include <algorithm>

#include "bench/roofline/roofline.h"

namespace mssim {

constexpr std::size_t bytes_per_slot = 3 * sizeof(float);

StepSize step_size(const System& system) {
  // On a grid a node's place determines its springs; a body stores two node indices and a rest length per
  // spring, as in the packed unit of Hong et al.
  const bool grid = std::holds_alternative<GridPatch>(system.topology);
  return {system.nodes(), system.springs.size(), grid ? 0. : 2 * sizeof(std::uint32_t) + sizeof(float)};
}

StepSize with_stored_springs(StepSize size, std::uint64_t stored) {
  size.bytes_per_spring *=
      static_cast<double>(stored) / static_cast<double>(std::max<std::uint64_t>(1, size.springs));
  return size;
}

StepCost step_cost(const Integrator& integrator, const StepSize& size, int steps_per_pass) {
  constexpr std::size_t slots_of_state = 4;  // position and velocity, read and written
  std::size_t slots = 0, node_flops = 0;
  for (std::size_t s = 0; s < integrator.stage_count; ++s) {
    slots += slots_moved(integrator.stages[s]);
    node_flops += flops_per_acceleration + line_flops(integrator.stages[s]);
  }
  const auto nodes = static_cast<double>(size.nodes), springs = static_cast<double>(size.springs);
  const auto stages = static_cast<double>(integrator.stage_count);
  const double slot_bytes = static_cast<double>(bytes_per_slot) * nodes;
  const double spring_bytes = size.bytes_per_spring * springs;
  const double bytes = steps_per_pass > 0 ? (slots_of_state * slot_bytes + spring_bytes) / steps_per_pass
                                          : static_cast<double>(slots) * slot_bytes + stages * spring_bytes;
  return {bytes, static_cast<double>(node_flops) * nodes + stages * flops_per_spring * springs};
}

double working_set_bytes(const Integrator& integrator, const StepSize& size) {
  const std::size_t pairs = stored_pairs(integrator, Storage::in_place).size();
  return static_cast<double>(2 * pairs * bytes_per_slot) * static_cast<double>(size.nodes) +
         size.bytes_per_spring * static_cast<double>(size.springs);
}

}  // namespace mssim
