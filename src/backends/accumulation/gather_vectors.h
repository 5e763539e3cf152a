#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "backends/vectors/step_kernels.h"
#include "model/system.h"

namespace mssim {

/// Every node of a cloth sums the forces of its own springs like `gather`, a vector of nodes at a time.
/// Beside `openmp`, which has vectors too, it shows what computing each spring once is worth. The instruction
/// set is the best one that has options.roots. Throws Unsupported for anything but a cloth.
std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options);

/// A cloth with the components x y z u v w (u v w: velocity).
using PairRows = RowLayout<6>;

/// What the vector code needs to take steps of a cloth. Pairs have PairRows::floats.
struct PaddedRows : SeparateSteps {
  PairRows layout;
  std::vector<SpringPerMass> springs;  ///< [kinds]
  std::size_t threads = 1;
  std::vector<PlacedPin> pins;         ///< row by row, at PairRows::offset
  std::vector<std::size_t> first_pin;  ///< [rows + 1] where a row's pins begin

  /// Throws Unsupported where the nodes differ in mass. Set a state before the first step.
  PaddedRows(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
             std::size_t lanes, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
};

/// Takes the vector code for another instruction set than the best.
std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options,
                                             const StepKernel<PaddedRows>& kernel);

}  // namespace mssim
