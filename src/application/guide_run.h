#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "application/choices.h"
#include "backends/backends.h"
#include "guide/guide.h"

namespace mssim {

/// What `mssim guide`, or a suite that it measures, was asked for. Without backends it takes
/// guide_backends(), without integrators guide_integrators.
struct GuideOptions : AskedCombinations {
  Wish wish;
  double horizon_s = 0.1;               ///< errors are measured so long after the start, at most
  std::optional<double> time_budget_s;  ///< for all scenes; none: usual_guide_s for each
  std::string folder;                   ///< empty: results are only printed
  bool overwrite = false;
  bool dry_run = false;
};

/// Wall time of a scene's guide where nothing is said of it, s.
inline constexpr double usual_guide_s = 90;

/// The backends and integrators that a guide takes unasked. The backends are the plain list, and those that
/// are fast.
std::vector<const BackendInfo*> guide_backends();
inline constexpr std::array<std::string_view, 1> guide_integrators{"all"};

/// Measures the scenes one after the other and prints of each the recommendation and its table; writes the
/// folder, where there is one, after each. Returns an ExitCode. Throws UsageError for names that are not
/// known, scenes that are garments and a folder that has results; and what reading scenes throws.
int run_guide(const GuideOptions& options);

}  // namespace mssim
