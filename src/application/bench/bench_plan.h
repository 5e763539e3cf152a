#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "application/choices.h"
#include "application/prepared_scene.h"
#include "backends/interface/backend.h"
#include "bench/estimates.h"
#include "bench/job/job.h"
#include "bench/machine/provenance.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// Where the results of a bench go.
struct BenchOutput {
  std::string folder;  ///< empty: they are only printed
  bool resume = false;
  bool overwrite = false;
  bool trace = false;
};

/// What `mssim bench` was asked for.
struct BenchOptions : AskedCombinations {
  std::string suite;
  std::vector<int>
      threads;  ///< backends that have threads also get a row for each that is less than execution's
  /// Backends with vector code also get a row for each of these but the best; empty: the best one only.
  std::vector<std::string> instruction_sets;
  std::optional<int> rounds;  ///< none: the usual number, or as many as the budget allows
  std::optional<double> time_budget_s;
  std::optional<double> fps;   ///< frames per second of simulated time; none: single frames are not timed
  std::optional<int> windows;  ///< none: only cloths that do not fit are verified in windows
  bool dry_run = false;
  BenchOutput output;
  bool new_references = false;  ///< those of earlier runs are not taken, nor is any kept
  std::string verified;         ///< a folder whose rows need not be verified again; empty: none
};

/// Rounds of a bench that says nothing of them.
inline constexpr int usual_rounds = 15;
inline constexpr int most_rounds = 100'000;

/// What the memory and the time of a scene with these counts depend on.
SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts);

/// A scene before a bench builds it. Its parts are read for the plan and dropped when the scene has been
/// built, so that they take no memory while it is measured; what those of some scenes take meanwhile is not
/// available to those that are planned after them, which are refused where it is missing.
struct UnbuiltScene {
  SceneSpec spec;
  SceneParts parts;

  /// Builds the scene, for the last time, and drops the parts. Throws SceneError.
  PreparedScene prepare();
};

/// A scene that a bench is to time.
struct PlannedScene : UnbuiltScene {
  std::vector<const BackendInfo*> backends;  ///< that are measured on it
  SceneSize size;
  std::uint64_t memory_bytes = 0;  ///< bench_memory_needed
  ExpectedTime time;
  std::vector<GridWindow> windows;  ///< in which it is verified and nobody here builds the whole; or none
};

/// What is prepared of a scene that is verified in windows: no node of it.
PreparedScene outline_of(const PlannedScene& planned);

/// A window of a cloth with its springs.
System build_window(const SceneSpec& spec, const GridWindow& window);

/// The times of the scenes alone.
std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes);

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
/// for a dry run with one number of threads. Throws UsageError for names that are not known, for nothing to
/// do and for options that do not go together; SceneError and MissingProgram for scenes that cannot be read,
/// meshed or held; and what reading published tables and the folder of verified rows throws.
BenchPlan plan_of(const BenchOptions& options);

}  // namespace mssim
