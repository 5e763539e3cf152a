#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/system.h"

namespace mssim {

/// The constant matrix of fast-springs' global step: M + h^2 L of Liu et al. 2013, Eq. 14, with damping. It
/// is that of the equation of backward Euler in the velocities w at the step's end,
///
///     A = (1 + dt viscous_damping) M + sum over springs of (dt^2 k + dt c) g g^T,   kg,
///
/// g: +1 at one end of the spring, -1 at the other. All three coordinates have the same one. Pinned nodes
/// have no row, so that a spring to one adds to the diagonal alone. A is positive definite, because masses
/// are positive and springs are not negative.
struct StepMatrix {
  /// A spring between two free nodes: -weight at (first, second) and (second, first). Both diagonals have it
  /// already.
  struct Coupling {
    std::uint32_t first, second;  ///< rows
    double weight;                ///< kg
  };

  std::vector<std::uint32_t> node;  ///< [rows] the scene's node, ascending: the free ones
  std::vector<double> diagonal;     ///< [rows] kg
  std::vector<Coupling> couplings;

  StepMatrix(const System& system, double dt_s);
  std::size_t rows() const { return node.size(); }
};

}  // namespace mssim
