#pragma once

#include <vector>

#include "backends/backends.h"
#include "commands/guide/guide_options.h"

namespace mssim {

/// The backends that a guide takes unasked: the plain list, and those that are fast.
std::vector<const BackendInfo*> guide_backends();

/// Measures the scenes one after the other and prints of each the recommendation and its table; writes the
/// folder, where there is one, after each. Returns an ExitCode. Throws UsageError for names that are not
/// known, scenes that are garments and a folder that has results; and what reading scenes throws.
int run_guide(const GuideOptions& options);

}  // namespace mssim
