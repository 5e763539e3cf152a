#include "garment/stepping/dressing_backend.h"

namespace mssim {

bool dresses(const Integrator& integrator) { return integrator.name == "semi-euler"; }

void require_semi_euler(const Integrator& integrator) {
  if (!dresses(integrator)) throw Unsupported("a garment is dressed with semi-euler only, as published");
}

}  // namespace mssim
