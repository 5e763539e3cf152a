#pragma once

#include <memory>

#include "backends/implicit/constraints/step_bodies.h"
#include "backends/implicit/constraints/step_cloth.h"
#include "backends/interface/backend.h"

namespace mssim {

/// xpbd of a cloth with this vector code. Throws Unsupported for anything else.
std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s, int threads,
                                                 const ClothConstraintKernel& kernel);

/// xpbd of any list of springs with this vector code.
std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s, int threads,
                                                 const BodyConstraintKernel& kernel);

}  // namespace mssim
