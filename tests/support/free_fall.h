#pragma once

#include "integrators/integrator.h"

namespace mssim {

/// How far `steps` of free fall from rest lead, in units of g dt^2. Semi-implicit and backward
/// Euler move with the speed at each step's end, explicit Euler with that at its start.
constexpr double fall_of(const Integrator& integrator, double steps) {
  const bool backward = is_implicit(integrator) && integrator.solver != Solver::constraints;
  if (backward || integrator.name == "semi-euler") return steps * (steps + 1) / 2;
  if (integrator.name == "explicit-euler") return steps * (steps - 1) / 2;
  return steps * steps / 2;
}

}  // namespace mssim
