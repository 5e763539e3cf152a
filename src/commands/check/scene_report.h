#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands/shared/prepared_scene.h"
#include "output/tables/table.h"

namespace mssim {

/// What a scene would be, told without a step of it.
struct SceneReport {
  Table scene;  ///< one row: what it is
  /// A row for each integrator and backend that can step it: the largest stable dt, the memory that a bench
  /// of this combination takes, and how long a bench and a run of it take, about.
  Table combinations;
  std::vector<std::string> warnings;  ///< sentences about what is allowed and seldom meant
};

/// Looks at a scene that has been built. The memory is for as many threads as there are processors, the time
/// of a bench for its usual rounds, that of a run for its usual duration.
SceneReport report_on(const PreparedScene& scene);

}  // namespace mssim
