#include "backends/implicit/newton/newton.h"

namespace mssim {

std::unique_ptr<Backend> make_serial_newton(const System& /*system*/, const Integrator& /*integrator*/,
                                            double /*dt_s*/) {
  throw Unsupported("it is not written yet");
}

std::unique_ptr<Backend> make_newton_reference(const System& /*system*/, const Integrator& /*integrator*/,
                                               double /*dt_s*/) {
  throw Unsupported("it is not written yet");
}

}  // namespace mssim
