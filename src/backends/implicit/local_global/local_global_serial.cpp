#include "backends/implicit/local_global/local_global.h"

namespace mssim {

std::unique_ptr<Backend> make_serial_local_global(const System& /*system*/, double /*dt_s*/) {
  throw Unsupported("it is not written yet");
}

std::unique_ptr<Backend> make_local_global_reference(const System& /*system*/, double /*dt_s*/) {
  throw Unsupported("it is not written yet");
}

}  // namespace mssim
