#include "backends/implicit/newton/newton.h"

namespace mssim {

std::unique_ptr<Backend> make_openmp_newton(const System& /*system*/, const Integrator& /*integrator*/,
                                            double /*dt_s*/, const ExecutionOptions& /*options*/) {
  throw Unsupported("it is not written yet");
}

}  // namespace mssim
