#include "backends/reference.h"

#include "backends/implicit/implicit.h"
#include "backends/interface/ahead.h"
#include "backends/spring_list/serial.h"

namespace mssim {

std::unique_ptr<Backend> make_reference(const System& system, const Integrator& integrator, double dt_s,
                                        const std::function<bool()>& stop) {
  if (is_implicit(integrator)) return make_implicit_reference(system, integrator, dt_s, stop);
  return step_ahead(make_serial_in_double(system, integrator, dt_s), system, integrator, dt_s);
}

MemoryUse reference_memory(const Integrator& integrator, bool grid) {
  if (is_implicit(integrator)) return implicit_reference_memory(integrator, grid);
  // A spring list of twice the bytes, but for a byte that says what is pinned.
  return {.node = 2 * spring_list_memory.node - 1, .pair_node = 2 * spring_list_memory.pair_node};
}

}  // namespace mssim
