#include "backends/implicit/constraints/constraints.h"

namespace mssim {

std::unique_ptr<Backend> make_openmp_constraints(const System& /*system*/, double /*dt_s*/,
                                                 const ExecutionOptions& /*options*/) {
  throw Unsupported("it is not written yet");
}

}  // namespace mssim
