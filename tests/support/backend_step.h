#pragma once

#include <cmath>

#include "integrators/integrator.h"

namespace mssim {

/// The step that tests of backends take with cloths and blocks (cloth_system.h, solid_system.h), which are
/// stable with it.
inline constexpr double backend_dt_s = 1e-4;

/// The same for any integrator: explicit Euler takes half of it, with which their damping keeps it from
/// growing.
constexpr double backend_dt_of(const Integrator& integrator) {
  return integrator.name == "explicit-euler" ? backend_dt_s / 2 : backend_dt_s;
}

/// Such steps in `seconds`.
inline int steps_in(const Integrator& integrator, double seconds) {
  return static_cast<int>(std::lround(seconds / backend_dt_of(integrator)));
}

}  // namespace mssim
