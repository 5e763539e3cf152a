#pragma once

#include <cstddef>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// Every node of a cloth sums the forces of its own springs like `gather`, a vector of nodes at a time. The
/// comparison with `openmp`, which also has vectors, shows the gain from computing each spring once. Uses the
/// best instruction set with options.roots, or options.instruction_set. Throws Unsupported except for a
/// cloth.
BackendMaker make_gather_vectors;

/// A cloth with the components x y z u v w (u v w: velocity).
using PairRows = RowLayout<6>;

/// Data of a cloth that the vector code needs to take steps. Pairs have PairRows::floats floats.
struct PaddedRows : SeparateSteps<float> {
  PairRows layout;
  std::vector<SpringPerMass> springs;  ///< [kinds]
  std::size_t threads = 1;
  std::vector<PlacedPin<float>> pins;  ///< by row, at PairRows::offset
  std::vector<std::size_t> first_pin;  ///< [rows + 1] begin of a row's pins

  /// Throws Unsupported if the nodes differ in mass. Set a state before the first step.
  PaddedRows(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
             std::size_t lanes, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
};

}  // namespace mssim
