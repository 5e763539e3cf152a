#pragma once

#include "backends/implicit/newton/newton.h"
#include "backends/implicit/newton/step_newton.h"

namespace mssim {

/// make_openmp_newton() with the vector code of one instruction set. most_kept: VectorEquation's.
std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options, const NewtonKernel& kernel,
                                            std::size_t most_kept = most_slope_bytes);

}  // namespace mssim
