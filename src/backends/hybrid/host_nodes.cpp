#include "backends/hybrid/host_nodes.h"

#include "backends/devices/device_queue.h"

namespace mssim {

HostNodes::HostNodes(const System& system, const Integrator& method, double dt_s)
    : packed(system),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)),
      constants(packed.slots() * 2) {
  constexpr std::size_t slice_nodes = PackedSprings::slice_nodes;
  const auto of_slot = [&](std::size_t slot) {
    return constants.data() + slot / slice_nodes * 2 * slice_nodes + slot % slice_nodes;
  };
  for (std::size_t slot = 0; slot < packed.slots(); ++slot) of_slot(slot)[slice_nodes] = 1;
  for (std::size_t node = 0; node < system.nodes(); ++node) {
    of_slot(packed.slot[node])[0] = static_cast<float>(1 / system.node_mass[node]);
    of_slot(packed.slot[node])[slice_nodes] = 0;
  }
  for (const std::uint32_t pin : system.pins) of_slot(packed.slot[pin])[slice_nodes] = 1;
  for (const SpringMaterial& material : system.materials)
    materials.push_back({static_cast<float>(material.stiffness), static_cast<float>(material.damping)});
}

SpringKernel HostNodes::spring_kernel(int lanes) const {
  const std::size_t units_of_part = lanes == 1 ? 1 : PackedSprings::slice_nodes;
  return {program_text(lanes, {"lanes.h", "records.h", "spring_law.h", "packed_springs.cl"}),
          "packed_spring_forces",
          packed.unit_count() / units_of_part,
          packed.slots() * record_floats,
          4 * (packed.unit_count() + 1),  // what lies behind the forces of the units stays zero
          {std::as_bytes(std::span(packed.units)), std::as_bytes(std::span(packed.entries)),
           std::as_bytes(std::span(materials))}};
}

void HostNodes::forget_units() {
  packed.units = {};
  packed.entries = {};
}

}  // namespace mssim
