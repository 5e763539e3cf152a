#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// Backends of the implicit integrators (integrators/all_integrators.h), each made in the room of its solver:
/// serial ones by plain loops over the spring list on one thread, references by the same in double precision,
/// openmp ones with vectors on options.threads threads, the same bits at every number of them. `system` is no
/// garment and outlives the backend.

/// implicit-euler and newton-euler.
std::unique_ptr<Backend> make_serial_newton(const System& system, const Integrator& integrator, double dt_s);
/// Newton's method, until nothing more is gained. Where `stop`, which is asked often in a step, says so, the
/// step ends there; the state is then of no use.
std::unique_ptr<Backend> make_newton_reference(const System& system, const Integrator& integrator,
                                               double dt_s, const std::function<bool()>& stop = {});
std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options);

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
/// All throw Unsupported where there is not the memory for the factor of A.
std::unique_ptr<Backend> make_serial_local_global(const System& system, double dt_s);
std::unique_ptr<Backend> make_local_global_reference(const System& system, double dt_s);
std::unique_ptr<Backend> make_openmp_local_global(const System& system, double dt_s,
                                                  const ExecutionOptions& options);

/// xpbd.
std::unique_ptr<Backend> make_serial_constraints(const System& system, double dt_s);
std::unique_ptr<Backend> make_constraints_reference(const System& system, double dt_s);
std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s,
                                                 const ExecutionOptions& options);

}  // namespace mssim
