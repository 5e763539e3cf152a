#pragma once

#include "integrators/all_integrators.h"

namespace mssim {

/// The integrator that tests dress garments with.
inline constexpr const Integrator& semi_euler = *find_integrator("semi-euler");

/// The step that tests dress panels of 1 cm (garment_system.h) with: 0.55 of the limit 2 / sqrt(2 sum k / m).
inline constexpr double dressing_dt_s = 1.5e-4;

}  // namespace mssim
