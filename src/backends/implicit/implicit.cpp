#include "backends/implicit/implicit.h"

#include <stdexcept>
#include <string>

#include "backends/implicit/constraints/constraints.h"
#include "backends/implicit/local_global/local_global.h"
#include "backends/implicit/newton/newton.h"

namespace mssim {
namespace {

[[noreturn]] void refuse_explicit(const Integrator& integrator) {
  throw std::invalid_argument(std::string(integrator.name) + " is no implicit integrator");
}

/// Sparse factors in double precision, with an index each: 5 to 6 entries a node and doubling are what
/// minimum degree leaves of the matrix of a cloth of 40,000 to 160,000 nodes.
constexpr double factor_bytes = 6 * 12;

}  // namespace

MemoryUse serial_implicit_memory(const Integrator& integrator, bool /*grid*/) {
  if (integrator.solver == Solver::local_global) return {.node = 150, .doubling_node = factor_bytes};
  if (integrator.solver == Solver::constraints) return {.node = 41, .spring = 16};
  return plain_newton_memory;
}

MemoryUse implicit_reference_memory(const Integrator& integrator, bool /*grid*/) {
  if (integrator.solver == Solver::local_global) return {.node = 250, .doubling_node = factor_bytes};
  if (integrator.solver == Solver::constraints) return {.node = 81, .spring = 16};
  return newton_reference_memory;
}

MemoryUse openmp_implicit_memory(const Integrator& integrator, bool grid) {
  // Bodies are cut into slices, as for explicit integrators, with each spring at both its ends.
  const double node = grid ? 0 : 130, spring = grid ? 0 : 38;
  if (integrator.solver == Solver::local_global)
    return {.node = node + 150, .doubling_node = factor_bytes, .spring = spring};
  if (integrator.solver == Solver::constraints) return {.node = node + 40, .spring = spring};
  return {.node = node + 8 * 12 + 24, .spring = spring};
}

std::unique_ptr<Backend> make_serial_implicit(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& /*options*/) {
  refuse_garment(system);
  switch (integrator.solver) {
    case Solver::newton_step:
    case Solver::newton:
      return make_serial_newton(system, integrator, dt_s);
    case Solver::local_global:
      return make_serial_local_global(system, dt_s);
    case Solver::constraints:
      return make_serial_constraints(system, dt_s);
    case Solver::none:
      break;
  }
  refuse_explicit(integrator);
}

std::unique_ptr<Backend> make_implicit_reference(const System& system, const Integrator& integrator,
                                                 double dt_s) {
  refuse_garment(system);
  switch (integrator.solver) {
    case Solver::newton_step:
    case Solver::newton:
      return make_newton_reference(system, integrator, dt_s);
    case Solver::local_global:
      return make_local_global_reference(system, dt_s);
    case Solver::constraints:
      return make_constraints_reference(system, dt_s);
    case Solver::none:
      break;
  }
  refuse_explicit(integrator);
}

std::unique_ptr<Backend> make_openmp_implicit(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options) {
  refuse_garment(system);
  switch (integrator.solver) {
    case Solver::newton_step:
    case Solver::newton:
      return make_openmp_newton(system, integrator, dt_s, options);
    case Solver::local_global:
      return make_openmp_local_global(system, dt_s, options);
    case Solver::constraints:
      return make_openmp_constraints(system, dt_s, options);
    case Solver::none:
      break;
  }
  refuse_explicit(integrator);
}

}  // namespace mssim
