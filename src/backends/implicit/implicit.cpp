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

}  // namespace

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
