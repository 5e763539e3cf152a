#pragma once

#include <string>
#include <vector>

#include "bench/job/scene_job.h"
#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The rows of a result folder in which all that is to be timed has been verified before, by the very program
/// that runs now (the same bytes), on the same machine, for the same threads, devices and scenes; whatever of
/// them failed there stays failed. Throws UsageError where it is not so, and what reading them throws.
/// `now`: with the scenes.
std::vector<ResultRow> verified_rows(const std::string& folder, const Provenance& now,
                                     const BenchSettings& settings, const std::vector<SceneSpec>& scenes);

}  // namespace mssim
