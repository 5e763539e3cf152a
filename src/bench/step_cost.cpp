#include "bench/step_cost.h"

namespace mssim {
namespace {

constexpr std::size_t bytes_per_slot = 3 * sizeof(float);

}  // namespace

StepCost step_cost(const Integrator& integrator, std::uint64_t nodes, std::uint64_t springs_unique) {
  std::size_t slots = 0, node_flops = 0;
  for (std::size_t s = 0; s < integrator.stage_count; ++s) {
    slots += slots_moved(integrator.stages[s]);
    node_flops += flops_per_acceleration + line_flops(integrator.stages[s]);
  }
  const auto node_count = static_cast<double>(nodes);
  const auto spring_count = static_cast<double>(springs_unique);
  return {static_cast<double>(slots * bytes_per_slot) * node_count,
          static_cast<double>(node_flops) * node_count +
              static_cast<double>(integrator.stage_count * flops_per_spring) * spring_count};
}

double working_set_bytes(const Integrator& integrator, std::uint64_t nodes) {
  std::size_t pairs = 0;
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    pairs += std::size_t{stores(integrator, static_cast<Pair>(pair), Storage::in_place)};
  return static_cast<double>(2 * pairs * bytes_per_slot) * static_cast<double>(nodes);
}

}  // namespace mssim
