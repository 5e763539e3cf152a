#pragma once

#include <optional>
#include <vector>

#include "bench/job/scene_job.h"
#include "bench/machine/provenance.h"
#include "commands/bench/bench_options.h"
#include "commands/bench/planned_scene.h"
#include "output/tables/published.h"
#include "output/tables/result_table.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What a bench does: made once, before anything is measured, and only read from then on, but for the parts
/// of scenes, which are dropped one after the other. Every scene file has been read, and every file that it
/// names; none is read again.
struct BenchPlan {
  BackendChoice backends;
  BenchSettings settings;  ///< of every scene
  std::optional<double> time_budget_s;
  std::vector<PlannedScene> timed;      ///< scenes that are measured
  std::vector<UnbuiltScene> described;  ///< scenes of which the structure is told
  bool uses_device = false;             ///< whether a backend that is timed uses an OpenCL device
  Provenance provenance;                ///< with all these scenes
  std::vector<PublishedTable> published;
  TableMaker tables;
  BenchOutput output;
};

/// How many rounds the scenes get, about.
double expected_rounds(const BenchPlan& plan);

/// Finds all that can be wrong with what was asked for. Asks for OpenCL devices where one will be used, but
/// for a dry run. Throws UsageError for names that are not known, for nothing to do and for options that do
/// not go together; SceneError and MissingProgram for scenes that cannot be read, meshed or held; and what
/// reading published tables and the folder of verified rows throws.
BenchPlan plan_of(const BenchOptions& options);

}  // namespace mssim
