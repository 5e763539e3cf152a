#pragma once

#include <cstdint>

namespace mssim {

/// How far the solvers of implicit integrators go.
struct SolverSettings {
  /// Of conjugate gradients and of Newton's method: where the norm of what is left is so small a part of what
  /// it was, they end.
  double tolerance = 1e-5;
  std::uint32_t iterations = 10;  ///< of fast-springs: local and global steps
  std::uint32_t substeps = 10;    ///< of xpbd: small steps in a step
};

}  // namespace mssim
