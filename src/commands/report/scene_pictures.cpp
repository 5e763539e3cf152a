#include "commands/report/scene_pictures.h"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>

#include "commands/run/run_scene.h"
#include "commands/shared/exit_code.h"
#include "output/pictures/painter.h"
#include "output/traces/trace_reader.h"
#include "picture/png.h"
#include "platform/temporary_folder.h"
#include "report/report_charts.h"
#include "scene/scene_file.h"
#include "text/decimal.h"
#include "text/fnv1a.h"

namespace mssim {
namespace {

constexpr double simulated_s = 0.5, patience_s = 0.5;

/// A scene to draw.
struct Sitter {
  const ResultRow* row = nullptr;
  const ReportFolder* folder = nullptr;
};

/// Seconds that simulating the row's scene takes by its backend.
double seconds_of(const ResultRow& row) {
  return row.dressing ? row.dressing->wall_s : *row.ms_per_step / 1000 * simulated_s / row.dt_s;
}

/// The largest of each kind that can be drawn soon.
std::map<SceneKind, Sitter> sitters_of(std::span<const ReportFolder> folders) {
  std::map<SceneKind, Sitter> sitters;
  for (const ReportFolder& folder : folders)
    for (const ResultRow& row : folder.rows) {
      if (row.backend != "openmp" || row.integrator != "semi-euler" || !counts(row) || !(row.dt_s > 0))
        continue;
      Sitter& known = sitters[kind_of(row)];
      if (seconds_of(row) <= patience_s && (!known.row || row.nodes > known.row->nodes))
        known = {&row, &folder};
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

FoundPicture drawn(const ResultRow& row) {
  RunOptions run;
  run.scene = row.scene;
  run.fps = 1 / simulated_s;
  if (!row.dressing) run.duration_s = simulated_s;
  run.files.trace = (temporary_folder_of_process() / (row.scene + ".h5")).string();
  run.silent = true;
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

}  // namespace

std::vector<FoundPicture> scene_pictures(std::span<const ReportFolder> folders,
                                         std::vector<std::string>& problems) {
  std::vector<FoundPicture> pictures;
  for (const auto& [kind, sitter] : sitters_of(folders)) {
    if (!sitter.row) continue;
    const std::string& name = sitter.row->scene;
    try {
      // What a folder calls by the name of a file would be read from wherever that leads.
      if (is_path_of_scene(name) || !is_measured(find_scene(name), *sitter.folder))
        problems.push_back("the scene " + name + " is not known as it was measured, and is not drawn");
      else
        pictures.push_back(drawn(*sitter.row));
    } catch (const std::exception& error) {
      problems.push_back("the scene " + name + " cannot be drawn: " + error.what());
    }
  }
  return pictures;
}

}  // namespace mssim
