#include "bench/step_start.h"

#include "backends/dressing/dressing_backend.h"

namespace mssim {

void begin(Backend& backend, const StepStart& start) {
  if (start.draped)
    dynamic_cast<DressingBackend&>(backend).set_draped_state(*start.state);
  else
    backend.set_state(*start.state);
}

}  // namespace mssim
