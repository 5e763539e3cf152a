#pragma once

namespace mssim {

/// The step that tests of backends take with cloths and blocks (cloth_system.h, solid_system.h), which are
/// stable with it.
inline constexpr double backend_dt_s = 1e-4;

}  // namespace mssim
