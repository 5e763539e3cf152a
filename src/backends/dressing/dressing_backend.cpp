#include "backends/dressing/dressing_backend.h"

namespace mssim {

void require_semi_euler(const Integrator& integrator) {
  if (integrator.name != "semi-euler")
    throw Unsupported("a garment is dressed with semi-euler only, as published");
}

}  // namespace mssim
