#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "garment/stepping/dressing_backend.h"

namespace mssim {

/// The instruction sets that the vector code is compiled for and this processor has, the best first.
std::vector<std::string_view> dressing_instruction_sets();

/// Algorithm 1 in vectors along the rows of the panels and on `threads` threads, with the same result to the
/// last bit for any number of them. An empty instruction set is the best. Throws Unsupported for another
/// integrator than semi-euler and for springs of one row and direction that differ in stiffness.
std::unique_ptr<DressingBackend> make_openmp_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, int threads,
                                                      std::string_view instruction_set = "");

}  // namespace mssim
