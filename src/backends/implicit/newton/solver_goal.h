#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "model/system.h"

namespace mssim {

/// Where the methods of newton_method.h end.
struct SolverGoal {
  double tolerance = 0;  ///< of newton_step and newtons_method: the part that may be left
  double rounding = 0;   ///< the norm of r, kg^1/2 m/s, which rounded forces do not let it fall below
  double rounding_of_motion = 0;  ///< what rounded velocities add to that, in parts of sqrt(w . M w)
};

/// What a spring's force is off by at most, in u k L: (k - k L / l) d is rounded where d, 1 / l and the
/// products with k L and with d are.
inline constexpr double roundings_of_force = 4;

/// The goal of a solver that computes springs in precision Real. Each error below changes from spring to
/// spring or from node to node, so that squares add up; u is half a unit in the last place of 1.
///
/// A spring's force is the difference of k l and k L, each rounded: an error of u k L. Newton's method on the
/// shipped cloths comes to a third of this, and not further.
///
/// Rounding w_j by u |w_j| changes r by column j of A. With a = dt c + dt^2 k of a spring, the largest
/// eigenvalue of what it adds to A, its square in the norm of M^-1 is at most
///     (m_j + dt viscous_damping m_j + sum of a)^2 / m_j + sum of a^2 / m_i
/// over the springs from j to i, times u^2 |w_j|^2; the largest of it over m_j |w_j|^2 is taken for all
/// nodes. That is an upper bound: it is no goal, but says whether a norm that does not fall is that of
/// roundings.
template <class Real>
SolverGoal solver_goal(const System& system, double dt_s, double tolerance) {
  constexpr double unit_roundoff = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
  double sum = 0;
  std::vector<double> diagonal, others(system.nodes());
  for (const double mass : system.node_mass) diagonal.push_back(mass * (1 + dt_s * system.viscous_damping));
  for (const Spring& spring : system.springs) {
    const SpringMaterial& material = system.materials[spring.kind];
    const double tension = material.stiffness * static_cast<double>(spring.rest_length);
    const double along = dt_s * (material.damping + dt_s * material.stiffness);
    for (const auto& [end, other] : {std::pair{spring.first, spring.second}, {spring.second, spring.first}}) {
      sum += tension * tension / system.node_mass[end];
      diagonal[end] += along;
      others[end] += along * along / system.node_mass[other];
    }
  }
  double column = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const double mass = system.node_mass[i];
    column = std::max(column, (diagonal[i] * diagonal[i] / mass + others[i]) / mass);
  }
  return {tolerance, unit_roundoff * dt_s * std::sqrt(sum), unit_roundoff * std::sqrt(column)};
}

}  // namespace mssim
