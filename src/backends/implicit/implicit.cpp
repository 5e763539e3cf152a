#include "backends/implicit/implicit.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "backends/implicit/nodes/solvers.h"

namespace mssim {
namespace {

/// The functions for the steps of one solver.
struct SolverSteps {
  BackendMaker* serial;
  MemoryUse serial_memory;
  ReferenceMaker* reference;
  MemoryUse reference_memory;
  BackendMaker* openmp;
  MemoryUse openmp_memory;  ///< for a cloth; for bodies, plus the memory of their slices
};

/// Memory of a SpringEquation<float>: per node PlainNodes, six vectors and a block of P; per spring its part
/// of A.
constexpr MemoryUse plain_newton{.node = 29 + 6 * 12 + 24, .spring = 20};

/// Entries of a sparse factor in minimum degree order, per node: 5 to 6 per doubling for a cloth of 40,000 to
/// 160,000 nodes; 5 to 7 per cube root of the number of nodes for the scenes of bodies, and 7 to 13 for one
/// body of 1,700 to 27,000.
constexpr double cloth_entries = 6, body_entries = 13;
/// An entry takes 12 bytes in Eigen's factor, and 12 in its copy; the matrix itself, in three forms, takes
/// matrix_bytes per node.
constexpr double entry_bytes = 2 * 12, matrix_bytes = 550;
/// openmp's blocks, besides their sources.
constexpr double block_bytes = 38;

/// Memory of slices, with each spring at both its ends, as for explicit integrators.
constexpr MemoryUse body_slices{.node = 130, .spring = 38};

constexpr SolverSteps newton{
    .serial = make_serial_newton,
    .serial_memory = plain_newton,
    .reference = make_newton_reference,
    .reference_memory = {.node = 2 * plain_newton.node - 1, .spring = 2 * plain_newton.spring},
    .openmp = make_openmp_newton,
    // Measured for a cloth of 700,000 nodes: eight vectors, a block, and temporary data for padding and
    // conversion.
    .openmp_memory = {.node = 165}};

constexpr SolverSteps local_global{
    .serial = make_serial_local_global,
    .serial_memory = {.node = 150 + matrix_bytes, .doubling_node = cloth_entries * entry_bytes},
    .reference = make_local_global_reference,
    .reference_memory = {.node = 250 + matrix_bytes, .doubling_node = cloth_entries * entry_bytes},
    .openmp = make_openmp_local_global,
    .openmp_memory = {.node = 150 + matrix_bytes, .doubling_node = cloth_entries * block_bytes}};

constexpr SolverSteps constraints{.serial = make_serial_constraints,
                                  .serial_memory = {.node = 53, .spring = 16 + 20},
                                  .reference = make_constraints_reference,
                                  .reference_memory = {.node = 105, .spring = 16 + 32},
                                  .openmp = make_openmp_constraints,
                                  .openmp_memory = {.node = 52}};

struct Row {
  Solver solver;
  SolverSteps steps;
};

/// The TABLE of solvers.
constexpr std::array<Row, 4> table{{{Solver::newton_step, newton},
                                    {Solver::newton, newton},
                                    {Solver::local_global, local_global},
                                    {Solver::constraints, constraints}}};

const SolverSteps& steps_of(const Integrator& integrator) {
  const auto row = std::ranges::find(table, integrator.solver, &Row::solver);
  if (row == table.end())
    throw std::invalid_argument(std::string(integrator.name) + " is not an implicit integrator");
  return row->steps;
}

/// Memory of the solver including its factor, for a cloth or for bodies.
MemoryUse filled(MemoryUse use, bool grid) {
  if (!grid) use.cube_root_node = body_entries / cloth_entries * std::exchange(use.doubling_node, 0);
  return use;
}

}  // namespace

MemoryUse serial_implicit_memory(const Integrator& integrator, bool grid) {
  return filled(steps_of(integrator).serial_memory, grid);
}

MemoryUse implicit_reference_memory(const Integrator& integrator, bool grid) {
  return filled(steps_of(integrator).reference_memory, grid);
}

MemoryUse openmp_implicit_memory(const Integrator& integrator, bool grid) {
  MemoryUse use = filled(steps_of(integrator).openmp_memory, grid);
  if (!grid) {
    use.node += body_slices.node;
    use.spring += body_slices.spring;
  }
  return use;
}

std::unique_ptr<Backend> make_serial_implicit(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options) {
  return steps_of(integrator).serial(system, integrator, dt_s, options);
}

std::unique_ptr<Backend> make_implicit_reference(const System& system, const Integrator& integrator,
                                                 double dt_s, const std::function<bool()>& stop) {
  return steps_of(integrator).reference(system, integrator, dt_s, stop);
}

std::unique_ptr<Backend> make_openmp_implicit(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options) {
  return steps_of(integrator).openmp(system, integrator, dt_s, options);
}

}  // namespace mssim
