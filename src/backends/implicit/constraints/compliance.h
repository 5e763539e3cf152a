#pragma once

#include "model/system.h"

namespace mssim {

/// A spring as the compliant constraint C = l - L of XPBD (M. Macklin, M. Müller, N. Chentanez, 2016), with
/// which a small step of h seconds from x, v goes on from the positions y = x + h v that the velocities lead
/// to. One iteration, as M. Macklin et al. (2019) advise, begins at lambda = 0; their Eq. 26 is then
///
///     dlambda = (-C - gamma n.(p2 - p1)) / ((1 + gamma) (w1 + w2) + alpha~),
///
/// n = (y2 - y1)/l, p = y - x, w: inverse mass, alpha~ = 1/(k h^2). The dissipation potential of a damping c
/// is c (dC/dt)^2 / 2, so beta~ = c h^2 and gamma = alpha~ beta~ / h = c/(k h). By Eq. 17 y1 changes by
/// -w1 dlambda n and y2 by the opposite. With p = h v, and all multiplied by k h^2, the velocity v1 changes
/// by
///
///     w1 h (k C + c n.(v2 - v1)) n / (1 + (h^2 k + h c) (w1 + w2)):
///
/// the force of kernels/spring_law.h at (y, v), for h seconds, divided by what it changes itself in that
/// time. So the same law gives the impulse, from other constants; velocities carry the displacements, which
/// single precision would lose in differences of positions; and a spring without stiffness is no exception.
///
/// These are the constants of the law with which its pull is that impulse divided by the vector to the other
/// end, kg/s. They are finite for all k and c that are not negative.
template <class Real>
struct Compliance {
  Real stiffness;       ///< h k / (1 + ...), kg/s
  Real stiffness_rest;  ///< that times the rest length, kg m/s
  Real damping;         ///< h c / (1 + ...), kg

  /// rest_length in m; h_s: the small step; mobility: w1 + w2, 1/kg, 0 for an end that is held.
  Compliance(const SpringMaterial& material, double rest_length, double h_s, double mobility) {
    const double impulse_per_force =
        h_s / (1 + (h_s * h_s * material.stiffness + h_s * material.damping) * mobility);
    stiffness = static_cast<Real>(material.stiffness * impulse_per_force);
    stiffness_rest = static_cast<Real>(material.stiffness * rest_length * impulse_per_force);
    damping = static_cast<Real>(material.damping * impulse_per_force);
  }
};

}  // namespace mssim
