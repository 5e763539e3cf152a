#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// Makes a reference, as make_reference (backends/backends.h) does.
using ReferenceMaker = std::unique_ptr<Backend>(const System& system, const Integrator& integrator,
                                                double dt_s, const std::function<bool()>& stop);

/// Backends of the implicit integrators (integrators/all_integrators.h), made in the solvers' folders: serial
/// ones with plain loops over the spring list on one thread, references the same in double precision, openmp
/// ones with vectors on options.threads threads, bitwise identical for every number of threads. `system` must
/// not be a garment and must outlive the backend.

/// implicit-euler and newton-euler.
BackendMaker make_serial_newton, make_openmp_newton;
/// Newton's method, until it improves no more. If `stop`, which is called often in a step, returns true, the
/// step ends early; the state is then useless.
ReferenceMaker make_newton_reference;

/// fast-springs (integrators/all_integrators.h): backward Euler by local and global steps (Liu, Bargteil,
/// O'Brien and Kavan 2013). Their local step finds each spring's direction d (Eq. 9), their global step
/// solves
///
///     (M + h^2 L) x = h^2 J d + M y + h^2 f_ext   (Eq. 14),   y = x_n + h v_n.
///
/// With the springs' forces at x, h^2 (J d - L x), on the right, the same x follows from its predecessor:
/// (M + h^2 L) (change of x) = residual of backward Euler at x. Here the unknown is the change of
/// w = (x - x_n) / h, so that single precision keeps its digits, and dampers are treated like springs:
///
///     A (change of w) = M (v_n - w) + dt F(x_n + dt w, w),   A: StepMatrix (factor.h),
///
/// from w = v_n, System::solver.iterations times, also in the reference: until it has converged to backward
/// Euler it is a method of its own. Neither Chebyshev nor Anderson acceleration is applied.
///
/// All throw Unsupported if there is too little memory for the factor of A.
BackendMaker make_serial_local_global, make_openmp_local_global;
ReferenceMaker make_local_global_reference;

/// xpbd.
BackendMaker make_serial_constraints, make_openmp_constraints;
ReferenceMaker make_constraints_reference;

}  // namespace mssim
