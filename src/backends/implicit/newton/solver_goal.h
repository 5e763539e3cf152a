#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "model/system.h"

namespace mssim {

/// Where the methods of newton_method.h end.
struct SolverGoal {
  double tolerance = 0;  ///< the part of the first norm of r
  double rounding = 0;   ///< the norm of r, kg^1/2 m/s, which the precision does not let it fall below
};

/// The goal of a solver that computes springs in precision Real. A spring's force is the difference of k l
/// and k L, each rounded to half a unit in its last place at most: an error of u k L that changes from spring
/// to spring, so that squares add up. Newton's method on the shipped cloths comes to a third of this, and not
/// further.
template <class Real>
SolverGoal solver_goal(const System& system, double dt_s, double tolerance) {
  constexpr double unit_roundoff = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
  double sum = 0;
  for (const Spring& spring : system.springs) {
    const double tension = system.materials[spring.kind].stiffness * static_cast<double>(spring.rest_length);
    for (const std::uint32_t end : {spring.first, spring.second})
      sum += tension * tension / system.node_mass[end];
  }
  return {tolerance, unit_roundoff * dt_s * std::sqrt(sum)};
}

}  // namespace mssim
