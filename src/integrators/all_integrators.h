#pragma once

#include <array>
#include <string_view>

#include "integrators/integrators.h"

namespace mssim {

/// The leapfrog of positions (Verlet 1967 in the form of Swope et al. 1982 with positions and velocities
/// exchanged): half a step of drift, a kick, half a step of drift,
///
///     y = x + dt/2 v,   v+ = v + dt a(y, v),   x+ = y + dt/2 v+,
///
/// which is semi-implicit Euler for the positions y, half a step ahead. Forces of positions alone make it
/// symplectic and of order 2. Damping is taken at the old velocity, which leaves order 1.
inline constexpr Integrator verlet = [] {
  Integrator row = integrators[0];
  row.name = "verlet";
  row.order = 2;
  row.damped_order = 1;
  row.description = "position Verlet: half a drift, a kick, half a drift; order 1 where velocities damp";
  row.paper_name = {};
  row.row = &integrators[0];
  row.ahead = 0.5;
  return row;
}();
static_assert(integrators[0].name == "semi-euler");

/// The TABLE of implicit integrators. A backend has them where its row has a make_implicit
/// (backends/backends.h). All but xpbd step towards backward Euler,
///
///     v+ = v + dt a(x+, v+),   x+ = x + dt v+.
inline constexpr auto implicit_integrators = std::to_array<Integrator>({
    {.name = "implicit-euler",
     .order = 1,
     .description = "one Newton step of backward Euler by conjugate gradients (Baraff and Witkin 1998)",
     .solver = Solver::newton_step},
    {.name = "newton-euler",
     .order = 1,
     .description = "backward Euler itself: Newton's method until it has converged",
     .solver = Solver::newton},
    {.name = "fast-springs",
     .order = 1,
     .description = "backward Euler by local and global steps, one factorisation (Liu et al. 2013)",
     .solver = Solver::local_global},
    {.name = "xpbd",
     .order = 1,
     .description = "compliant constraints, spring after spring, in small steps (Macklin et al. 2016, 2019)",
     .solver = Solver::constraints},
});

/// All integrators, in the order of every listing and result.
inline constexpr auto all_integrators = [] {
  std::array<const Integrator*, integrators.size() + 1 + implicit_integrators.size()> all{};
  std::size_t count = 0;
  for (const Integrator& integrator : integrators) all[count++] = &integrator;
  all[count++] = &verlet;
  for (const Integrator& integrator : implicit_integrators) all[count++] = &integrator;
  return all;
}();

/// The integrator of that name, or nullptr.
constexpr const Integrator* find_integrator(std::string_view name) {
  for (const Integrator* integrator : all_integrators)
    if (integrator->name == name) return integrator;
  return nullptr;
}

}  // namespace mssim
