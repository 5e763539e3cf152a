#include "report/report.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "application/console.h"
#include "application/outputs.h"
#include "application/run.h"
#include "commands/command.h"
#include "commands/result_folders.h"
#include "output/folders/history_file.h"
#include "output/pictures/painter.h"
#include "output/traces/trace_reader.h"
#include "picture/picture.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr double simulated_s = 0.5, patience_s = 0.5;
constexpr const char* integrator = "semi-euler";

/// Seconds that simulating the row's scene takes by its backend.
double seconds_of(const ResultRow& row) {
  return row.dressing ? row.dressing->wall_s : *row.ms_per_step / 1000 * simulated_s / row.dt_s;
}

/// Calls `simulate` with a row of each kind of scene: of the largest that comes with mssim, is `wanted` and
/// can be simulated soon. What that throws becomes a problem of the input.
template <class Wanted, class Simulate>
void for_each_sitter(ReportInput& input, Wanted wanted, Simulate simulate) {
  std::map<ContentKind, const ResultRow*> sitters;
  for (const ReportFolder& folder : input.folders)
    for (const ResultRow& row : folder.rows) {
      if (row.backend != "openmp" || row.integrator != integrator || !counts(row) || !(row.dt_s > 0) ||
          !row.scene_as_shipped || !wanted(row) || seconds_of(row) > patience_s)
        continue;
      const ResultRow*& known = sitters[kind_of(row)];
      if (!known || row.nodes > known->nodes) known = &row;
    }
  for (const auto& [kind, sitter] : sitters) {
    try {
      simulate(*sitter);
    } catch (const std::exception& error) {
      input.problems.push_back(
          fmt::format("the scene {} cannot be simulated: {}", sitter->scene, error.what()));
    }
  }
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
  return {fmt::format("{}, {} nodes, after {:.2f} s", row.scene, grouped(row.nodes),
                      trace.content().time_s.back()),
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

/// Simulates scenes of the folders anew, by `openmp`, if they come with mssim: of each kind of scene the
/// largest that takes no more than about half a second, as the folder's times tell, for half a second of its
/// time, or until its garment hangs, to draw it; and of each kind the largest of those that has a reference,
/// named as the scene, for its energies. Adds a problem where one cannot be simulated. Throws Interrupted.
void simulate_scenes(ReportInput& input) {
  for_each_sitter(
      input, [](const ResultRow&) { return true; },
      [&](const ResultRow& row) { input.pictures.push_back(drawn(row)); });
  const auto reference = [&](const ResultRow& row) { return reference_of(row.scene, input.references); };
  for_each_sitter(input, reference,
                  [&](const ResultRow& row) { input.curves.push_back(energies(row, *reference(row))); });
}

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> folders;
  std::string out = "report.html";
  std::string history;
  bool no_runs = false;
};

int report(const ReportOptions& options) {
  const fs::path out = target_of(options.out);
  require_extension({"--out", out}, "HTML", {".html", ".htm"});
  AtomicFile(out).remove();  // finds what cannot be written before anything is read
  ReportInput input = report_input(options.folders);
  if (!options.history.empty()) input.history = read_history(options.history);
  if (!options.no_runs) simulate_scenes(input);
  write_file_atomically(out, report_page(input));
  tell_of_problems(input);
  tell("wrote {}", printable(out.string()));
  return exit_ok;
}

}  // namespace

std::function<int()> declare_report(Arguments& arguments) {
  const auto options = std::make_shared<ReportOptions>();
  add_result_folders(arguments, options->folders);
  arguments.add("--out FILE", options->out, "File to write (default: report.html)");
  arguments.add("--history FILE", options->history,
                "Also show the times of commits, which mssim history add keeps in this file");
  arguments.add_flag("--no-runs", options->no_runs,
                     "Simulate no scenes for pictures and energies, which takes seconds; what lies in the "
                     "folders is shown");
  return [options] { return report(*options); };
}

}  // namespace mssim
