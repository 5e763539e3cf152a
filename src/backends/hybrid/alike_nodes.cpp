#include "backends/hybrid/alike_nodes.h"

#include "backends/devices/device_queue.h"

namespace mssim {

AlikeNodes::AlikeNodes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
                       double dt_s)
    : springs(bodies),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)) {}

SpringKernel AlikeNodes::spring_kernel(int lanes) const {
  const std::size_t parts = AlikeSprings::slice_nodes / static_cast<std::size_t>(lanes);
  return {slices_program_text(AlikeSprings::slice_nodes, lanes,
                              {"lanes.h", "spring_law.h", "alike_slices.h", "alike_springs.cl"}),
          "alike_spring_forces",
          springs.springs.size() * parts,
          springs.slices.floats(),
          springs.springs.size() * 3 * AlikeSprings::slice_nodes,
          {std::as_bytes(std::span(springs.springs)), std::as_bytes(std::span(springs.shapes))}};
}

}  // namespace mssim
