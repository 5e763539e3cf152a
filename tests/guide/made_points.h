#pragma once

#include <string>
#include <string_view>

#include "guide/limits.h"
#include "integrators/all_integrators.h"

namespace mssim {

/// A point that counts. `cost`: wall seconds a simulated second.
inline WorkPoint made_point(std::string_view integrator, double dt_s, double cost, double error,
                            const std::string& backend = "openmp") {
  WorkPoint point;
  point.integrator = find_integrator(integrator);
  point.backend = backend;
  point.dt_s = dt_s;
  point.seconds_a_step = cost * dt_s;
  point.position_error = error;
  point.energy_error = 0;
  return point;
}

}  // namespace mssim
