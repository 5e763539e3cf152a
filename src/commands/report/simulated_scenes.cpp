#include "commands/report/simulated_scenes.h"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>

#include "commands/run/run_scene.h"
#include "output/pictures/painter.h"
#include "output/traces/trace_reader.h"
#include "picture/png.h"
#include "platform/files.h"
#include "report/report_charts.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr double simulated_s = 0.5, patience_s = 0.5;
constexpr const char* integrator = "semi-euler";

/// A scene to simulate.
struct Sitter {
  const ResultRow* row = nullptr;
  const ReportFolder* folder = nullptr;
};

/// Seconds that simulating the row's scene takes by its backend.
double seconds_of(const ResultRow& row) {
  return row.dressing ? row.dressing->wall_s : *row.ms_per_step / 1000 * simulated_s / row.dt_s;
}

/// The largest of each kind that is `wanted` and can be simulated soon.
template <class Wanted>
std::map<ContentKind, Sitter> sitters_of(std::span<const ReportFolder> folders, Wanted wanted) {
  std::map<ContentKind, Sitter> sitters;
  for (const ReportFolder& folder : folders)
    for (const ResultRow& row : folder.rows) {
      if (row.backend != "openmp" || row.integrator != integrator || !counts(row) || !(row.dt_s > 0) ||
          !wanted(row) || seconds_of(row) > patience_s)
        continue;
      Sitter& known = sitters[kind_of(row)];
      if (!known.row || row.nodes > known.row->nodes) known = {&row, &folder};
    }
  return sitters;
}

/// Whether the folder was measured with this text of the scene.
bool is_measured(const SceneSpec& spec, const ReportFolder& folder) {
  if (!folder.provenance) return false;
  const auto& scenes = folder.provenance->scenes;
  const auto scene = std::ranges::find(scenes, spec.name, &SceneHash::name);
  return scene != scenes.end() && scene->fnv1a_64 == fnv1a_64(spec.source);
}

RunOptions run_of(const ResultRow& row) {
  RunOptions run;
  run.scene = row.scene;
  run.integrator = integrator;
  run.silent = run.files.temporary = true;
  return run;
}

FoundPicture drawn(const ResultRow& row) {
  RunOptions run = run_of(row);
  run.fps = 1 / simulated_s;
  if (!row.dressing) run.duration_s = simulated_s;
  run.files.trace = (temporary_folder_of_process() / (row.scene + ".h5")).string();
  run_scene(run);
  const TraceReader trace(run.files.trace);
  const std::vector<Vec3d> positions = trace.positions(trace.frames() - 1);
  PictureOptions options;
  options.view = *view_direction("three-quarter");
  options.width = 640;
  options.height = 480;
  Painter painter(trace.content(), trace.positions(0), options);
  painter.make_room_for(positions);
  return {row.scene + ", " + grouped(row.nodes) + " nodes, after " +
              fixed_decimal(trace.content().time_s.back(), 2) + " s",
          png_of(painter.picture_of(positions))};
}

/// Its energies at the times of the reference.
FoundCurve energies(const ResultRow& row, const FoundCurve& reference) {
  RunOptions run = run_of(row);
  run.duration_s = reference.time_s.back();
  run.fps = static_cast<double>(reference.time_s.size() - 1) / reference.time_s.back();
  run.files.energy_curve = (temporary_folder_of_process() / (row.scene + ".csv")).string();
  run_scene(run);
  return energy_curve_in(row.scene + ", openmp, " + integrator, read_file(run.files.energy_curve)).value();
}

const FoundCurve* reference_of(const std::string& scene, std::span<const FoundCurve> references) {
  const auto found = std::ranges::find(references, scene, &FoundCurve::name);
  return found == references.end() || found->time_s.size() < 2 ? nullptr : &*found;
}

/// Calls `simulate` with the rows of those sitters whose scenes are known.
template <class Simulate>
void for_each_sitter(const std::map<ContentKind, Sitter>& sitters, std::vector<std::string>& problems,
                     Simulate simulate) {
  for (const auto& [kind, sitter] : sitters) {
    const std::string& name = sitter.row->scene;
    try {
      // What a folder calls by the name of a file would be read from wherever that leads.
      if (is_path_of_scene(name) || !is_measured(find_scene(name), *sitter.folder))
        problems.push_back("the scene " + name + " is not known as it was measured, and is not simulated");
      else
        simulate(*sitter.row);
    } catch (const std::exception& error) {
      problems.push_back("the scene " + name + " cannot be simulated: " + error.what());
    }
  }
}

}  // namespace

SimulatedScenes simulated_scenes(std::span<const ReportFolder> folders,
                                 std::span<const FoundCurve> references, std::vector<std::string>& problems) {
  SimulatedScenes scenes;
  for_each_sitter(sitters_of(folders, [](const ResultRow&) { return true; }), problems,
                  [&](const ResultRow& row) { scenes.pictures.push_back(drawn(row)); });
  const auto has_reference = [&](const ResultRow& row) {
    return reference_of(row.scene, references) != nullptr;
  };
  for_each_sitter(sitters_of(folders, has_reference), problems, [&](const ResultRow& row) {
    scenes.curves.push_back(energies(row, *reference_of(row.scene, references)));
  });
  return scenes;
}

}  // namespace mssim
