#include <utility>

#include "backends/implicit/newton/newton_method.h"
#include "backends/implicit/newton/spring_equation.h"
#include "backends/implicit/newton/step_newton.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"

namespace mssim {

namespace {

template <class Real>
class NewtonSerial final : public Backend {
 public:
  NewtonSerial(const System& system, const Integrator& integrator, double dt_s, double tolerance,
               std::function<bool()> stop = {})
      : equation_(system, dt_s, std::move(stop)),
        integrator_(integrator),
        goal_(solver_goal<Real>(system, dt_s, tolerance)) {}

  void set_state(const State& state) override { equation_.set_state(state); }
  State state() const override { return equation_.state(); }
  int threads() const override { return 1; }
  std::string note() const override { return note_of(work_); }

  void step(int count) override {
    try {
      for (int step = 0; step < count; ++step) take_step(equation_, integrator_, goal_, work_);
    } catch (const GivenUp&) {
      // The caller stopped it.
    }
  }

 private:
  SpringEquation<Real> equation_;
  const Integrator& integrator_;
  const SolverGoal goal_;
  SolverWork work_;
};

/// Relative tolerance of the reference's solvers, negligible against a step's own error.
constexpr double reference_tolerance = 1e-12;

}  // namespace

std::unique_ptr<Backend> make_serial_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& /*options*/) {
  return std::make_unique<NewtonSerial<float>>(system, integrator, dt_s, system.solver.tolerance);
}

std::unique_ptr<Backend> make_newton_reference(const System& system, const Integrator& integrator,
                                               double dt_s, const std::function<bool()>& stop) {
  return std::make_unique<NewtonSerial<double>>(system, integrator, dt_s, reference_tolerance, stop);
}

std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return make_vector_backend<VectorEquation<NodeRows>, VectorEquation<NodeSlices>>(system, dt_s, options,
                                                                                   integrator);
}

}  // namespace mssim
