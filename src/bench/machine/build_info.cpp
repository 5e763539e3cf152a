#include "bench/machine/provenance.h"
#include "mssim/commit.h"
#include "mssim/version.h"

namespace mssim {

const BuildInfo& build_info() {
  static const BuildInfo info{MSSIM_VERSION,  MSSIM_COMMIT, MSSIM_DIRTY,
                              MSSIM_COMPILER, MSSIM_FLAGS,  MSSIM_BUILD_TYPE};
  return info;
}

}  // namespace mssim
