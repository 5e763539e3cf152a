#pragma once

#include <string>
#include <vector>

#include "bench/machine/provenance.h"

namespace mssim {

/// What makes times on this machine longer, or different from run to run: one sentence each with what to do,
/// from the machine's load, governor and turbo and from the threads asked for and where they may run. What
/// the system does not tell is no noise.
std::vector<std::string> noise_of(const Provenance& provenance);

}  // namespace mssim
