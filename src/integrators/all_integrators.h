#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "integrators/integrator.h"

namespace mssim {

/// The TABLE of integrators with stages. A new explicit method is one row here, for every backend.
///
/// Equations (2) to (4) are those of Hong et al. 2016, "Integration methods for physically-based simulation".
/// The paper calls them semi-Euler, midpoint ("adding a midpoint step") and 4th-order Runge-Kutta ("4 trial
/// steps for approximations of slope"). The rows are the textbook methods of these names; the order of the
/// updates and the slots are ours. The paper measures no other method: those marked as ours are comparisons.
inline constexpr auto integrators = std::to_array<Integrator>({
    // Eq. (2). Ours is which comes first: v+ = v + dt a(x, v), then x+ = x + dt v+.
    of_stages("semi-euler", 1, "semi-implicit Euler", "semi-euler",
              {{{Pair::state,
                 {{{Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}},  //
                   {Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::v_next}}}}}}}}}),

    // Eq. (3), two evaluations: half an Euler step to the midpoint, then a whole step with the slopes there.
    of_stages("midpoint", 2, "explicit midpoint rule", "midpoint",
              {{{Pair::state,
                 {{{Slot::x_a, {{{1, 0, Slot::x}, {1. / 2, 1, Slot::v}}}},  //
                   {Slot::v_a, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}}}}},
                {Pair::trial_a,
                 {{{Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::v_a}}}},  //
                   {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}),

    // Eq. (4), four evaluations: the classical method. Ours: `next` gathers the weighted slopes, and two
    // trial pairs alternate.
    of_stages("rk4", 4, "classical fourth-order Runge-Kutta", "rk4",
              {{{Pair::state,
                 {{{Slot::x_a, {{{1, 0, Slot::x}, {1. / 2, 1, Slot::v}}}},
                   {Slot::v_a, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}},
                   {Slot::x_next, {{{1, 0, Slot::x}, {1. / 6, 1, Slot::v}}}},
                   {Slot::v_next, {{{1, 0, Slot::v}, {1. / 6, 1, Slot::a}}}}}}},
                {Pair::trial_a,
                 {{{Slot::x_b, {{{1, 0, Slot::x}, {1. / 2, 1, Slot::v_a}}}},
                   {Slot::v_b, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}},
                   {Slot::x_next, {{{1, 0, Slot::x_next}, {1. / 3, 1, Slot::v_a}}}},
                   {Slot::v_next, {{{1, 0, Slot::v_next}, {1. / 3, 1, Slot::a}}}}}}},
                {Pair::trial_b,
                 {{{Slot::x_a, {{{1, 0, Slot::x}, {1, 1, Slot::v_b}}}},
                   {Slot::v_a, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}},
                   {Slot::x_next, {{{1, 0, Slot::x_next}, {1. / 3, 1, Slot::v_b}}}},
                   {Slot::v_next, {{{1, 0, Slot::v_next}, {1. / 3, 1, Slot::a}}}}}}},
                {Pair::trial_a,
                 {{{Slot::x_next, {{{1, 0, Slot::x_next}, {1. / 6, 1, Slot::v_a}}}},
                   {Slot::v_next, {{{1, 0, Slot::v_next}, {1. / 6, 1, Slot::a}}}}}}}}}),

    // Ours: midpoint with one acceleration, x+ = x + dt (v + dt/2 a).
    of_stages("midpoint-frozen", 1, "midpoint trial step with the acceleration of the start", "midpoint",
              {{{Pair::state,
                 {{{Slot::temporary_1, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}},
                   {Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::temporary_1}}}},
                   {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}),

    // Ours: RK4 with one acceleration; the four slopes of x are v, v + dt/2 a (twice) and v + dt a.
    of_stages("rk4-frozen", 1, "RK4 trial steps with the acceleration of the start", "rk4",
              {{{Pair::state,
                 {{{Slot::temporary_1, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}},
                   {Slot::temporary_2, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}},
                   {Slot::x_next,
                    {{{1, 0, Slot::x},
                      {1. / 6, 1, Slot::v},
                      {2. / 3, 1, Slot::temporary_1},
                      {1. / 6, 1, Slot::temporary_2}}}},
                   {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}),

    // Ours, for comparison: Euler's method, x+ = x + dt v, v+ = v + dt a(x, v). It feeds energy into every
    // undamped oscillation, at every dt.
    of_stages("explicit-euler", 1, "explicit Euler: unstable at every dt without damping", {},
              {{{Pair::state,
                 {{{Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::v}}}},
                   {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}),
});

static_assert(std::ranges::all_of(integrators, gathers_safely),
              "a stage writes the pair that it gathers from: OpenCL and graphs would race");

/// The names of those that Hong et al. measure.
inline constexpr auto paper_integrators = [] {
  std::array<std::string_view, static_cast<std::size_t>(std::ranges::count_if(integrators, is_of_paper))>
      names{};
  auto name = names.begin();
  for (const Integrator& integrator : integrators)
    if (is_of_paper(integrator)) *name++ = integrator.name;
  return names;
}();

/// The leapfrog of positions (Verlet 1967 in the form of Swope et al. 1982 with positions and velocities
/// exchanged): half a step of drift, a kick, half a step of drift,
///
///     y = x + dt/2 v,   v+ = v + dt a(y, v),   x+ = y + dt/2 v+,
///
/// which is semi-implicit Euler for the positions y, half a step ahead. If forces depend only
/// on positions, it is symplectic and of order 2. Damping uses the old velocity, which leaves order 1.
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

/// The TABLE of implicit integrators. A backend supports them if its row has a make_implicit
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
