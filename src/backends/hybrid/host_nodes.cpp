#include "backends/hybrid/host_nodes.h"

namespace mssim {

HostNodes::HostNodes(const System& system, const Integrator& method, double dt_s)
    : packed(system),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)),
      constants(packed.places() * 2) {
  constexpr std::size_t slice_nodes = PackedSprings::slice_nodes;
  const auto of_place = [&](std::size_t place) {
    return constants.data() + place / slice_nodes * 2 * slice_nodes + place % slice_nodes;
  };
  for (std::size_t place = 0; place < packed.places(); ++place) of_place(place)[slice_nodes] = 1;
  for (std::size_t node = 0; node < system.nodes(); ++node) {
    of_place(packed.place[node])[0] = static_cast<float>(1 / system.node_mass[node]);
    of_place(packed.place[node])[slice_nodes] = 0;
  }
  for (const std::uint32_t pin : system.pins) of_place(packed.place[pin])[slice_nodes] = 1;
}

}  // namespace mssim
