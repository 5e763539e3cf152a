#pragma once

#include "model/system.h"

namespace mssim {

/// The largest eigenvalues of a system about a state: what bounds the step of an explicit integrator.
struct Spectrum {
  double stiffness = 0;  ///< 1/s^2, of M^-1 K: the square of the fastest angular frequency
  double damping = 0;    ///< 1/s, of M^-1 C, viscous damping included
};

/// The spectral radii of M^-1 K and M^-1 C at `state`, by power iteration (for example Golub and Van Loan,
/// Matrix Computations, section 7.3.1) from a fixed pseudo-random vector: x becomes M^-1 K x, and its
/// Rayleigh quotient in the inner product of M, which is at most the largest eigenvalue, tends to it. K and C
/// are the derivatives of the spring forces by positions and velocities (kernels/spring_jacobian.h), where
/// pinned nodes do not move. Ends where a hundred iterations have raised the quotient by less than a
/// thousandth, or after 3,000. A garment's joints and contacts are left out.
Spectrum spectrum_at(const System& system, const State& state);

}  // namespace mssim
