#include "application/bench/bench_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

#include "application/bench/suites.h"
#include "application/console.h"
#include "bench/results/comparison.h"
#include "integrators/all_integrators.h"
#include "output/folders/provenance_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

std::vector<ResultRow> rows_of_scene(const std::vector<ResultRow>& rows, const std::string& scene) {
  std::vector<ResultRow> its;
  std::ranges::copy_if(rows, std::back_inserter(its),
                       [&](const ResultRow& row) { return row.scene == scene; });
  return its;
}

void replace_rows(std::vector<ResultRow>& rows, const std::string& scene, std::vector<ResultRow> its) {
  // No row before the scene's first one is erased, so its place stays.
  const auto before = std::ranges::find(rows, scene, &ResultRow::scene) - rows.begin();
  std::erase_if(rows, [&](const ResultRow& row) { return row.scene == scene; });
  std::ranges::move(its, std::inserter(rows, rows.begin() + before));
}

namespace {

/// Whether the row has the frames that are asked for, or says why it has none.
bool has_frames(const BenchSettings& settings, const ResultRow& row) {
  if (!settings.fps) return true;
  const int steps = steps_of_frame(*settings.fps, row.dt_s);
  return row.frame_steps == static_cast<std::uint64_t>(steps) ||
         row.note.find(untimed_frames(steps)) != std::string::npos;
}

}  // namespace

bool is_finished(const BenchSettings& settings, const std::string& scene,
                 const std::vector<ResultRow>& earlier, const std::string& folder) {
  if (earlier.empty()) return false;
  std::set<std::pair<std::string, std::string>> asked, measured;
  for (const Integrator* integrator : settings.integrators)
    for (const BackendInfo* backend : settings.backends) asked.emplace(backend->name, integrator->name);
  for (const ResultRow& row : earlier) measured.emplace(row.backend, row.integrator);
  if (asked != measured)
    throw UsageError(
        "{} has other backends or integrators of {} than this command: --resume needs the same ones; choose "
        "another --out, or --overwrite to measure again",
        folder, scene);
  return std::ranges::all_of(earlier, [&](const ResultRow& row) {
    return row.status != "ok" ||
           (row.rounds >= settings.rounds && has_frames(settings, row) && !has_unchecked_samples(row));
  });
}

namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw UsageError("there is no {}: give a folder that mssim bench --out wrote", path.string());
  fs::path folder = fs::is_directory(status) ? path
                    : path.has_parent_path() ? path.parent_path()
                                             : fs::path(".");
  if (!fs::exists(folder / timings_name, error))
    throw UsageError("{} holds no timings.csv: give a folder that mssim bench --out wrote",
                     folder == path
                         ? path.string()
                         : fmt::format("{} is a file, and its folder {}", path.string(), folder.string()));
  return folder;
}

/// Throws UsageError unless the row has a time, and a sample of every round, within the bounds of times.
void require_samples(const ResultRow& row, const fs::path& folder) {
  if (row.status != "ok") return;
  const std::string where = (folder / samples_name).string() + ": " + combination_name(row) + " has ";
  if (row.samples_ms.empty())
    throw UsageError(where +
                     "no samples, although its status in timings.csv is ok; measure the folder again");
  if (row.samples_ms.size() != static_cast<std::size_t>(row.rounds))
    throw UsageError("{}{}, but {} in timings.csv: one of the files is damaged; measure the folder again",
                     where, pluralize(row.samples_ms.size(), "sample"), pluralize(row.rounds, "round"));
  const std::string timings = (folder / timings_name).string();
  if (!row.ms_per_step)
    throw UsageError("{}: {} has no ms_per_step, although its status is ok; measure the folder again",
                     timings, combination_name(row));
  for (const TimeColumn& column : time_columns)
    if (const std::optional<double> value = row.*column.value; value && !is_time(*value))
      throw UsageError("{}: {} of {} is {:.6g}, {}; measure the folder again", timings, column.name,
                       combination_name(row), *value, not_a_time);
  for (std::size_t round = 0; round < row.samples_ms.size(); ++round)
    if (!is_time(row.samples_ms[round]))
      throw UsageError("{}{:.6g} ms in round {}, {}; measure the folder again", where, row.samples_ms[round],
                       round + 1, not_a_time);
}

/// Throws UsageError if there are reasons why --resume cannot continue in the folder.
void require_resumable(const std::vector<std::string>& differences, const std::string& folder) {
  if (!differences.empty())
    throw UsageError("--resume cannot continue in " + folder + ": " + join(differences, "; ") +
                     "; choose another --out, or --overwrite to measure again");
}

std::string revision(const BuildInfo& build) {
  return std::string(build.commit) + (build.dirty ? ", changed" : "");
}

/// The variables that decide where OpenMP's threads run and how they wait: not those that print something,
/// and not the number of threads, which is compared by itself.
std::string thread_variables(const Provenance& provenance) {
  std::vector<std::string> variables;
  for (const auto& [name, value] : provenance.thread_environment)
    if (!name.starts_with("OMP_DISPLAY_") && name != "OMP_AFFINITY_FORMAT" && name != "OMP_NUM_THREADS")
      variables.push_back(printable(name + '=' + value));
  return variables.empty() ? "empty" : join(variables, " ");
}

/// What differs of that on which times and results depend.
std::vector<std::string> changed_conditions(const Provenance& then, const Provenance& now) {
  std::vector<std::string> all = differences(then, now);
  const auto shown = [](const std::string& value) { return value.empty() ? "not given" : printable(value); };
  for (const RecordedSetting& setting : recorded_settings)
    if (const std::string& was = then.*setting.value, &is = now.*setting.value; was != is)
      all.push_back(fmt::format("{} was {} and is {}", setting.option, shown(was), shown(is)));
  // A bench whose backends need no OpenCL device records none.
  if (!then.opencl_devices.empty() && !now.opencl_devices.empty() &&
      then.opencl_devices != now.opencl_devices)
    all.emplace_back("the OpenCL devices or their drivers are not the same");
  if (then.tetgen != now.tetgen) all.emplace_back("TetGen is not the same");
  return all;
}

/// A table must not mix results of different programs or machines, nor contain rows that its provenance does
/// not describe.
void require_same_origin(const Provenance& earlier, const Provenance& now, const std::string& folder) {
  std::vector<std::string> all = changed_conditions(earlier, now);
  if (revision(earlier.build) != revision(now.build))
    all.push_back(fmt::format("the program was built from commit {} and is now from {}",
                              revision(earlier.build), revision(now.build)));
  else if (earlier.program_fnv1a_64 && earlier.program_fnv1a_64 != now.program_fnv1a_64)
    all.emplace_back("it is from another build of the program, whose file differs");
  const auto cpus_of = [](const Provenance& run) {
    return printable(fmt::format("{}", fmt::join(run.allowed_cpus, ",")));
  };
  if (earlier.allowed_cpus != now.allowed_cpus)
    all.push_back(fmt::format("the CPUs that it may use were {} and are {}", cpus_of(earlier), cpus_of(now)));
  if (const std::string then = thread_variables(earlier), present = thread_variables(now); then != present)
    all.push_back(fmt::format("the environment of OpenMP was {} and is {}", then, present));
  if (earlier.backend_programs != now.backend_programs)
    all.emplace_back("a program that is a backend is not the same");
  std::vector<std::string> left_out;
  for (const SceneHash& scene : earlier.scenes)
    if (std::ranges::find(now.scenes, scene.name, &SceneHash::name) == now.scenes.end())
      left_out.push_back(printable(scene.name));
  if (!left_out.empty())
    all.push_back(fmt::format("it has results of {}, which this command leaves out", join(left_out, ", ")));
  require_resumable(all, folder);
}

/// Rows of the folder that are to stay: with --resume those of an earlier run of the same program on the same
/// machine, with --overwrite none. Throws UsageError if the folder has results and neither option was given,
/// or if --resume would mix different origins or keep scenes that this command does not have; and the errors
/// of reading.
std::vector<ResultRow> earlier_rows(ResultFolder& folder, const BenchPlan& plan) {
  if (!folder.has_results()) return {};
  const BenchOutput& output = plan.output;
  if (output.resume) {
    const Provenance earlier = read_provenance(std::filesystem::path(output.folder) / provenance_name);
    require_same_origin(earlier, plan.provenance, output.folder);
    folder.go_on_with(earlier);
    if (!folder.has_rows()) return {};
    std::vector<ResultRow> rows = read_run(output.folder).rows;
    mark_own_scenes(rows, plan.provenance);
    return rows;
  }
  if (!output.overwrite)
    throw UsageError(output.folder +
                     " already holds results: give another --out, --resume to continue them, "
                     "or --overwrite to replace them");
  folder.replace_results();
  return {};
}

/// Reasons why an earlier verification may not hold now.
std::vector<std::string> doubts(const Provenance& then, const Provenance& now) {
  std::vector<std::string> all = changed_conditions(then, now);
  if (!then.program_fnv1a_64 || then.program_fnv1a_64 != now.program_fnv1a_64)
    all.emplace_back("it was written by another program");
  for (const BackendProgramRecord& program : now.backend_programs)
    if (std::ranges::find(then.backend_programs, program) == then.backend_programs.end())
      all.push_back(fmt::format("the program {} is not the same", program.name));
  for (const SceneHash& scene : now.scenes)
    if (std::ranges::find(then.scenes, scene.name, &SceneHash::name) == then.scenes.end())
      all.push_back("it has no scene " + scene.name);
  return all;
}

std::optional<ResultFolder> folder_of(const BenchPlan& plan) {
  if (plan.output.folder.empty()) return std::nullopt;
  return std::make_optional<ResultFolder>(plan.output.folder, plan.provenance, plan.tables);
}

/// Rows with the names that the plan's will have.
std::vector<ResultRow> planned_rows(const BenchPlan& plan) {
  std::vector<ResultRow> rows;
  for (const PlannedScene& scene : plan.timed)
    for (const Integrator* integrator : plan.settings.integrators)
      for (const BackendInfo* backend : scene.backends) {
        ResultRow& row = rows.emplace_back();
        row.scene = scene.spec.name;
        row.backend = backend->name;
        row.integrator = integrator->name;
      }
  return rows;
}

void add_published_times(std::vector<ResultRow>& rows, const BenchPlan& plan) {
  mark_own_scenes(rows, plan.provenance);
  static const PaperLegend legend = paper_legend();
  for (ResultRow& row : rows) {
    const auto backend = std::ranges::find(legend.backends, row.backend, &PaperLegend::Backend::name);
    if (!row.scene_as_shipped || backend == legend.backends.end()) continue;
    for (const PublishedTable& table : plan.published)
      if (const auto ms = table.ms(find_integrator(row.integrator)->paper_name, backend->configuration,
                                   row.nodes, row.springs_published))
        row.paper_ms = ms;
  }
}

}  // namespace

MeasuredRun read_run(const fs::path& path) {
  const fs::path folder = folder_of(path);
  MeasuredRun run{read_provenance(folder / provenance_name), read_results(folder)};
  for (const ResultRow& row : run.rows) require_samples(row, folder);
  return run;
}

std::vector<ResultRow> verified_rows(const std::string& folder, const Provenance& now) {
  MeasuredRun earlier = read_run(folder);
  if (const std::vector<std::string> all = doubts(earlier.provenance, now); !all.empty())
    throw UsageError("--verified cannot rely on {}: {}; leave it out to verify again", folder,
                     join(all, "; "));
  return std::move(earlier.rows);
}

void tell_unchecked_samples(std::span<const ResultRow> rows, const std::string& folder) {
  if (const std::string sentence = about_unchecked_samples(rows); !sentence.empty())
    tell("{}{}", folder.empty() ? "" : printable(folder) + ": ", sentence);
}

void require_rows(const std::vector<ResultRow>& verified, const std::string& scene,
                  const BenchSettings& settings, const std::string& folder) {
  const std::vector<const ResultRow*> rows = pointers_to(verified);
  for (const Integrator* integrator : settings.integrators)
    for (const BackendInfo* backend : settings.backends) {
      const ResultRow* row = find_row(rows, scene, backend->name, integrator->name);
      if (row == nullptr)
        throw UsageError(
            "--verified {} has no row of {}, {}, {}: ask for what it has, or leave --verified out", folder,
            scene, backend->name, integrator->name);
      if (has_unchecked_samples(*row))
        throw UsageError(
            "--verified {}: the samples of {} are not checked, because its run was ended before that; "
            "finish it with --resume, or leave --verified out",
            folder, combination_name(*row));
    }
}

BenchResults::BenchResults(const BenchPlan& plan)
    : plan_(plan),
      folder_(folder_of(plan)),
      rows_(folder_ ? earlier_rows(*folder_, plan) : std::vector<ResultRow>()) {
  if (!folder_) return;
  folder_->require_free(planned_rows(plan), plan.output.trace);
  folder_->begin();
}

std::vector<std::string> BenchResults::stems_of_scene(const std::string& name) const {
  std::vector<std::string> stems = file_stems(rows_), of_scene;
  for (std::size_t i = 0; i < stems.size(); ++i)
    if (rows_[i].scene == name) of_scene.push_back(std::move(stems[i]));
  return of_scene;
}

void BenchResults::keep(const std::string& scene, std::vector<ResultRow> rows) {
  require_resumable(differences(of_scene(scene), rows), plan_.output.folder);
  add_published_times(rows, plan_);
  replace_rows(rows_, scene, std::move(rows));
  if (folder_) folder_->write(rows_);
}

}  // namespace mssim
