#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/expected_time.h"
#include "commands/bench/bench_plan.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What the memory and the time of a scene with these counts depend on.
SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts);

/// A scene that a bench is to time, before it is built.
struct PlannedScene {
  std::string name;
  SceneSize size;
  ExpectedTime time;
};

/// The plan's timed scenes. Throws SceneError where one needs more memory than there is: a user shall not
/// wait for a scene only to see the program killed. Throws like counts_of.
std::vector<PlannedScene> planned_scenes(const BenchPlan& plan);

/// Their times alone.
std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes);

/// Prints what would be measured, and about how long that takes.
void tell_plan(const BenchPlan& plan, const std::vector<PlannedScene>& scenes,
               std::optional<double> time_budget_s);

}  // namespace mssim
