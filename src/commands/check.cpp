#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <variant>
#include <vector>

#include "application/bench/bench_plan.h"
#include "application/bench/suites.h"
#include "application/choices.h"
#include "application/prepared_scene.h"
#include "application/run.h"
#include "backends/backends.h"
#include "bench/estimates.h"
#include "commands/command.h"
#include "commands/options.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "integrators/stability.h"
#include "output/tables/table.h"
#include "platform/machine.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// What a scene would be, told without a step of it.
struct SceneReport {
  Table scene;  ///< one row: what it is
  /// A row for each integrator and backend that can step it: the largest stable dt, the memory that a bench
  /// of this combination takes, and how long a bench and a run of it take, about.
  Table combinations;
  std::vector<std::string> warnings;  ///< sentences about what is allowed and seldom meant
};

/// A bench of these backends and integrators, as it is where nothing else is asked for.
BenchSettings usual_settings(std::vector<const BackendInfo*> backends,
                             std::vector<const Integrator*> integrators) {
  BenchSettings settings;
  settings.backends = std::move(backends);
  settings.integrators = std::move(integrators);
  settings.execution = complete({});
  settings.rounds = usual_rounds;
  return settings;
}

double seconds_of(const BenchSettings& settings, const SceneSize& size) {
  return expected_time(settings, size).with(settings.rounds);
}

Table scene_table(const PreparedScene& scene) {
  const auto* mesh = std::get_if<TetrahedralMesh>(&scene.system.topology);
  Table table;
  table.add({{"scene", scene.spec.name},
             {"kind", kind_of(scene.spec).name},
             {"nodes", scene.counts.nodes},
             {"springs_unique", scene.counts.springs_unique},
             {"tetrahedra", mesh ? Cell(mesh->tetrahedra.size()) : Cell()},
             {"dt_s", scene.dt_s}});
  return table;
}

bool can_step(const SceneSize& size, const Integrator& integrator, const BackendInfo& backend) {
  if (size.garment) return dresses(integrator) && dresses(backend);
  return !is_implicit(integrator) || backend.make_implicit != nullptr;
}

void add_combination(Table& table, const PreparedScene& scene, const SceneSize& size,
                     const Integrator& integrator, const BackendInfo& backend, double largest_dt_s) {
  const BenchSettings settings = usual_settings({&backend}, {&integrator});
  const double steps = (size.garment ? SettlingRule{}.longest_s : default_duration_s) / scene.dt_s;
  table.add({{"integrator", integrator.name},
             {"largest_stable_dt_s", std::isinf(largest_dt_s) ? Cell() : Cell(largest_dt_s)},
             {"stable", scene.dt_s <= largest_dt_s},
             {"backend", backend.name},
             {"memory_bytes", bench_memory_needed(settings, size)},
             {"bench_s", seconds_of(settings, size)},
             {"run_s", expected_run_time(backend, integrator, size, steps)}});
}

/// The integrators that a bench takes unasked.
std::vector<const Integrator*> usual_integrators() {
  std::vector<const Integrator*> usual;
  for (const std::string_view name : comparison_of_suite("").integrators)
    usual.push_back(find_integrator(name));
  return usual;
}

/// Names the integrators, of those that a bench takes unasked, with which the scene may blow up: the limit is
/// on the safe side.
std::optional<std::string> warning_of_dt(const PreparedScene& scene, const ModeBound& modes) {
  std::vector<std::string_view> unstable;
  double smallest = scene.dt_s;
  for (const Integrator* integrator : usual_integrators()) {
    if (is_garment(scene.system) && !dresses(*integrator)) continue;
    const double limit = largest_stable_dt(*integrator, modes);
    if (scene.dt_s <= limit) continue;
    unstable.push_back(integrator->name);
    smallest = std::min(smallest, limit);
  }
  if (unstable.empty()) return std::nullopt;
  std::ostringstream text;
  text.precision(3);
  text << "dt_s " << scene.dt_s << " is above the stability limit of " << listed(unstable)
       << ", with which the scene may blow up: give at most " << smallest << ", or \"auto\"";
  return text.str();
}

/// A bench that says nothing of backends and integrators takes them all at once.
std::optional<std::string> warning_of_memory(const SceneSize& size) {
  const BenchSettings settings = usual_settings(comparison_of_suite("").backends(), usual_integrators());
  const auto shortage = memory_shortage(bench_memory_needed(settings, size));
  if (!shortage) return std::nullopt;
  return fmt::format("a bench of all backends {}: name fewer with --backend or --integrator", *shortage);
}

/// Looks at a scene that has been built. The memory is for as many threads as there are processors, the time
/// of a bench for its usual rounds, that of a run for its usual duration.
SceneReport report_on(const PreparedScene& scene) {
  const SceneSize size = size_of(scene.spec, scene.counts);
  const ModeBound modes = mode_bound(scene.system);
  SceneReport report;
  report.scene = scene_table(scene);
  for (const Integrator* integrator : all_integrators) {
    const double largest_dt_s = largest_stable_dt(*integrator, modes);
    for (const BackendInfo& backend : backends())
      if (can_step(size, *integrator, backend))
        add_combination(report.combinations, scene, size, *integrator, backend, largest_dt_s);
  }
  if (!scene.note.empty()) report.warnings.push_back(scene.note);
  for (auto&& warning : {warning_of_dt(scene, modes), warning_of_memory(size)})
    if (warning) report.warnings.push_back(*warning);
  return report;
}

struct CheckOptions {
  std::vector<std::string> scenes;
  ListingFormat format = ListingFormat::table;
};

/// For a reader: what the scene is in a line of its own.
std::string as_tables(const SceneReport& report) {
  return to_text(report.scene) + '\n' + to_text(report.combinations);
}

/// Adds each combination with what its scene is.
void add_rows(Table& rows, const SceneReport& report) {
  rows.columns = report.scene.columns;
  std::ranges::copy(report.combinations.columns, std::back_inserter(rows.columns));
  for (const std::vector<Cell>& combination : report.combinations.rows)
    std::ranges::copy(combination, std::back_inserter(rows.rows.emplace_back(report.scene.rows.front())));
}

int run(const CheckOptions& options) {
  Table rows;
  std::string tables;
  for (const std::string& name : options.scenes) {
    const PreparedScene scene = prepare_scene(find_scene(name));
    const SceneReport report = report_on(scene);
    for (const std::string& warning : report.warnings)
      std::cerr << "mssim: " << scene.spec.name << ": " << warning << '\n';
    tables += (tables.empty() ? "" : "\n") + as_tables(report);
    add_rows(rows, report);
  }
  std::cout << (options.format == ListingFormat::table ? tables : to_text(rows, options.format));
  return exit_ok;
}

}  // namespace

std::function<int()> declare_check(Arguments& arguments) {
  const auto options = std::make_shared<CheckOptions>();
  add_scenes(arguments, "SCENE", options->scenes, "Scenes to check: names (see mssim list scenes) or files")
      .required();
  declare_listing_format(arguments, options->format);
  return [options] { return run(*options); };
}

}  // namespace mssim
