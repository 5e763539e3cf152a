#pragma once

#include <memory>

#include "garment/stepping/dressing_backend.h"

namespace mssim {

/// Algorithm 1 of Vassilev's paper as a straightforward program has it: one thread, an array of nodes, a list
/// of springs, six loops. `system.topology` is a Garment. Throws Unsupported for another integrator than
/// semi-euler.
std::unique_ptr<DressingBackend> make_serial_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s);

/// The serial dressing in double precision.
std::unique_ptr<DressingBackend> make_reference_dressing(const System& system, const Integrator& integrator,
                                                         double dt_s);

}  // namespace mssim
