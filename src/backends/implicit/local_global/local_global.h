#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// fast-springs (integrators/all_integrators.h): backward Euler by local and global steps (Liu, Bargteil,
/// O'Brien and Kavan 2013). Their local step finds each spring's direction d (Eq. 9), their global step
/// solves
///
///     (M + h^2 L) x = h^2 J d + M y + h^2 f_ext   (Eq. 14),   y = x_n + h v_n.
///
/// With h^2 (J d - L x), the springs' forces at x, on the right, the same x is found from the one before it:
/// (M + h^2 L) (change of x) = what is missing for x to be a step of backward Euler. Here the change of
/// w = (x - x_n) / h is sought, so that single precision keeps its digits, and dampers are springs' equals:
///
///     A (change of w) = M (v_n - w) + dt F(x_n + dt w, w),   A: StepMatrix (factor.h),
///
/// from w = v_n, System::solver.iterations times, in the reference, too: it is a method of its own until it
/// has converged to backward Euler. Neither Chebyshev's nor Anderson's acceleration is applied.
///
/// `system` is no garment and outlives the backend. All throw Unsupported where there is not the memory for
/// the factor of A.

/// By plain loops over the spring list on one thread.
std::unique_ptr<Backend> make_serial_local_global(const System& system, double dt_s);

/// The plain solver in double precision.
std::unique_ptr<Backend> make_local_global_reference(const System& system, double dt_s);

/// With vectors, on as many threads: the same bits at every number of them.
std::unique_ptr<Backend> make_openmp_local_global(const System& system, double dt_s,
                                                  const ExecutionOptions& options);

}  // namespace mssim
