#include "report/report.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <system_error>
#include <vector>

#include "application/bench/suites.h"
#include "application/console.h"
#include "application/outputs.h"
#include "application/prepared_scene.h"
#include "application/run.h"
#include "bench/machine/provenance.h"
#include "commands/command.h"
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

/// The largest of each kind that is `wanted` and can be simulated soon.
template <class Wanted>
std::map<ContentKind, const ResultRow*> sitters_of(std::span<const ReportFolder> folders, Wanted wanted) {
  std::map<ContentKind, const ResultRow*> sitters;
  for (const ReportFolder& folder : folders)
    for (const ResultRow& row : folder.rows) {
      if (row.backend != "openmp" || row.integrator != integrator || !counts(row) || !(row.dt_s > 0) ||
          !wanted(row) || seconds_of(row) > patience_s)
        continue;
      const ResultRow*& known = sitters[kind_of(row)];
      if (!known || row.nodes > known->nodes) known = &row;
    }
  return sitters;
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

/// Calls `simulate` with the rows of those sitters whose scenes are known.
template <class Simulate>
void for_each_sitter(const std::map<ContentKind, const ResultRow*>& sitters,
                     std::vector<std::string>& problems, Simulate simulate) {
  for (const auto& [kind, sitter] : sitters) {
    const std::string& name = sitter->scene;
    try {
      if (!sitter->scene_as_shipped)
        problems.push_back("the scene " + name + " is not known as it was measured, and is not simulated");
      else
        simulate(*sitter);
    } catch (const std::exception& error) {
      problems.push_back(fmt::format("the scene {} cannot be simulated: {}", name, error.what()));
    }
  }
}

/// Simulates scenes of the folders anew, by `openmp`: of each kind of scene the largest that takes no more
/// than about half a second, as the folder's times tell, for half a second of its time, or until its garment
/// hangs, to draw it; and of each kind the largest of those that has a reference, named as the scene, for its
/// energies. Adds a problem where one cannot be simulated, for example because the scene of that name is not
/// the one that was measured. Throws Interrupted.
void simulate_scenes(ReportInput& input) {
  for_each_sitter(sitters_of(input.folders, [](const ResultRow&) { return true; }), input.problems,
                  [&](const ResultRow& row) { input.pictures.push_back(drawn(row)); });
  const auto has_reference = [&](const ResultRow& row) {
    return reference_of(row.scene, input.references) != nullptr;
  };
  for_each_sitter(sitters_of(input.folders, has_reference), input.problems, [&](const ResultRow& row) {
    input.curves.push_back(energies(row, *reference_of(row.scene, input.references)));
  });
}

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> folders;
  std::string out = "report.html";
  bool no_runs = false;
};

/// What to give in place of a folder without results: those in it that lead to some.
std::string below(const fs::path& folder) {
  std::string text;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory(error) && !result_folders(entry->path()).empty())
      text += (text.empty() ? "" : ", ") + printable(entry->path().string());
  return text.empty() ? "folders that mssim bench --out wrote" : "folders in it that have some: " + text;
}

/// The result folders that the given ones stand for. Throws UsageError for one that is none.
std::vector<fs::path> folders_of(const ReportOptions& options) {
  std::vector<fs::path> folders;
  for (const std::string& given : options.folders) {
    std::error_code error;
    if (!fs::is_directory(given, error))
      throw UsageError("there is no folder {}: give folders that mssim bench --out wrote", printable(given));
    std::vector<fs::path> found = result_folders(given);
    if (found.empty()) throw UsageError("{} has no results: give {}", printable(given), below(given));
    std::ranges::move(found, std::back_inserter(folders));
  }
  return folders;
}

std::vector<FoundCurve> reference_curves() {
  std::vector<FoundCurve> curves;
  std::error_code error;
  for (fs::directory_iterator entry(data_folder() / "reference", error), end; !error && entry != end;
       entry.increment(error))
    if (auto curve = energy_curve_in(entry->path().stem().string(), read_file(entry->path())))
      curves.push_back(std::move(*curve));
  return curves;
}

int report(const ReportOptions& options) {
  const std::vector<fs::path> folders = folders_of(options);
  const fs::path out = target_of(options.out);
  require_extension({"--out", out}, "HTML", {".html", ".htm"});
  AtomicFile(out).remove();  // finds what cannot be written before anything is read
  ReportInput input;
  input.made_by = "mssim " + build_info().version;
  input.legend = paper_legend();
  try {
    input.published = published_tables();
    input.tables = comparison_of_suite("tables").tables();
    input.references = reference_curves();
  } catch (const std::exception& error) {
    input.problems.push_back(std::string(error.what()) + "; nothing published is shown");
  }
  try {
    input.claims = published_claims();
  } catch (const std::exception& error) {
    input.problems.push_back(std::string(error.what()) + "; no claim of the papers is judged");
  }
  for (const fs::path& folder : folders) {
    ReportFolder& read = input.folders.emplace_back(read_report_folder(folder));
    mark_own_scenes(read.rows, read.provenance.value_or(Provenance()));
  }
  if (!options.no_runs) simulate_scenes(input);
  write_file_atomically(out, report_page(input));
  for (const ReportFolder& folder : input.folders)
    input.problems.insert(input.problems.end(), folder.problems.begin(), folder.problems.end());
  tell_first(input.problems);
  std::cerr << "mssim: wrote " << printable(out.string()) << '\n';
  return exit_ok;
}

}  // namespace

std::function<int()> declare_report(Arguments& arguments) {
  const auto options = std::make_shared<ReportOptions>();
  arguments
      .add_list("DIR... DIR", options->folders,
                "Folders that mssim bench --out wrote; a folder of such folders stands for all in it",
                [](std::string_view folder) { return std::vector{std::string(folder)}; })
      .required();
  arguments.add("--out FILE", options->out, "File to write (default: report.html)");
  arguments.add_flag("--no-runs", options->no_runs,
                     "Simulate no scenes for pictures and energies, which takes seconds; what lies in the "
                     "folders is shown");
  return [options] { return report(*options); };
}

}  // namespace mssim
