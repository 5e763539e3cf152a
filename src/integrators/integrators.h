#pragma once

#include <array>
#include <span>
#include <string_view>

#include "integrators/integrator.h"

namespace mssim {

/// The TABLE of integrators that are stages. A new explicit method is one row here, and every backend has it.
/// all_integrators.h has the others, too.
///
/// Numbering of the equations: Hong et al. 2016. Their published times fit one force evaluation a step for
/// all three methods (midpoint costs 1.04 and RK4 1.22 Euler steps), so beside the real methods stand
/// `-frozen` ones, which hold the acceleration over the step and take the trial steps with it.
inline constexpr auto integrators = std::to_array<Integrator>({
    // Eq. (2): v+ = v + dt a(x, v), x+ = x + dt v+.
    {"semi-euler",
     1,
     1,
     "semi-implicit Euler",
     "semi-euler",
     {{{Pair::state,
        {{{Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}},  //
          {Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::v_next}}}}}}}}}},

    // Eq. (3): a half Euler step to the midpoint, then a whole step with the slopes found there.
    {"midpoint",
     2,
     2,
     "explicit midpoint rule",
     "midpoint",
     {{{Pair::state,
        {{{Slot::x_a, {{{1, 0, Slot::x}, {1. / 2, 1, Slot::v}}}},  //
          {Slot::v_a, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}}}}},
       {Pair::trial_a,
        {{{Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::v_a}}}},  //
          {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}},

    // Eq. (4): the classical method; `next` gathers the weighted slopes, two trial pairs alternate.
    {"rk4",
     4,
     4,
     "classical fourth-order Runge-Kutta",
     "rk4",
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
          {Slot::v_next, {{{1, 0, Slot::v_next}, {1. / 6, 1, Slot::a}}}}}}}}}},

    // Midpoint with one acceleration: x+ = x + dt (v + dt/2 a).
    {"midpoint-frozen",
     1,
     1,
     "midpoint trial step, acceleration held: the cost that Hong et al. published",
     "midpoint",
     {{{Pair::state,
        {{{Slot::temporary_1, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}},
          {Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::temporary_1}}}},
          {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}},

    // RK4 with one acceleration: the four slopes of x are v, v + dt/2 a (twice) and v + dt a.
    {"rk4-frozen",
     1,
     1,
     "RK4 trial steps, acceleration held: the cost that Hong et al. published",
     "rk4",
     {{{Pair::state,
        {{{Slot::temporary_1, {{{1, 0, Slot::v}, {1. / 2, 1, Slot::a}}}},
          {Slot::temporary_2, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}},
          {Slot::x_next,
           {{{1, 0, Slot::x},
             {1. / 6, 1, Slot::v},
             {2. / 3, 1, Slot::temporary_1},
             {1. / 6, 1, Slot::temporary_2}}}},
          {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}},

    // Euler's method: x+ = x + dt v, v+ = v + dt a(x, v). It feeds energy into every undamped oscillation, at
    // every dt: Hong et al. name it as what Eq. (2) improves on.
    {"explicit-euler",
     1,
     1,
     "explicit Euler: unstable at every dt without damping",
     {},
     {{{Pair::state,
        {{{Slot::x_next, {{{1, 0, Slot::x}, {1, 1, Slot::v}}}},
          {Slot::v_next, {{{1, 0, Slot::v}, {1, 1, Slot::a}}}}}}}}}},
});

constexpr bool all_gather_safely() {
  for (const Integrator& integrator : integrators)
    if (!gathers_safely(integrator)) return false;
  return true;
}
static_assert(all_gather_safely(),
              "a stage writes the pair that it gathers from: OpenCL and graphs would race");

}  // namespace mssim
