#include "backends/implicit/constraints/constraints.h"

namespace mssim {

std::unique_ptr<Backend> make_serial_constraints(const System& /*system*/, double /*dt_s*/) {
  throw Unsupported("it is not written yet");
}

std::unique_ptr<Backend> make_constraints_reference(const System& /*system*/, double /*dt_s*/) {
  throw Unsupported("it is not written yet");
}

}  // namespace mssim
