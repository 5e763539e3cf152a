#include "backends/implicit/local_global/local_global.h"

namespace mssim {

std::unique_ptr<Backend> make_openmp_local_global(const System& /*system*/, double /*dt_s*/,
                                                  const ExecutionOptions& /*options*/) {
  throw Unsupported("it is not written yet");
}

}  // namespace mssim
