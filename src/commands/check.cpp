#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <memory>
#include <variant>
#include <vector>

#include "application/bench/bench_plan.h"
#include "application/bench/suites.h"
#include "application/choices.h"
#include "application/console.h"
#include "application/prepared_scene.h"
#include "application/run.h"
#include "backends/backends.h"
#include "bench/estimates.h"
#include "bench/verification/verification.h"
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

/// Settings of a bench of these backends and integrators with default options.
BenchSettings usual_settings(std::vector<const BackendInfo*> backends,
                             std::vector<const Integrator*> integrators) {
  BenchSettings settings;
  settings.backends = std::move(backends);
  settings.integrators = std::move(integrators);
  settings.execution = complete({});
  settings.rounds = usual_rounds;
  return settings;
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

bool can_step(const System& system, const Integrator& integrator, const BackendInfo& backend) {
  if (const auto* garment = std::get_if<Garment>(&system.topology))
    return dresses(integrator) && unsupported_reason(backend, *garment).empty();
  return unsupported_reason(backend, integrator).empty();
}

/// A row for each integrator and backend that can step the scene: the largest stable dt, the memory of a
/// bench of this combination with all processors, and the expected times of a bench and a run of default
/// length.
Table combination_table(const PreparedScene& scene, const SceneSize& size, const ModeBound& modes) {
  const double steps = (size.garment ? SettlingRule{}.longest_s : default_duration_s) / scene.dt_s;
  Table table;
  const std::vector<const BackendInfo*> all =
      size.garment ? with_garment_backends(table_backends()) : table_backends();
  for (const Integrator* integrator : all_integrators) {
    const double largest_dt_s = largest_stable_dt(*integrator, modes);
    for (const BackendInfo* backend : all) {
      if (!can_step(scene.system, *integrator, *backend)) continue;
      const BenchSettings settings = usual_settings({backend}, {integrator});
      table.add({{"integrator", integrator->name},
                 {"largest_stable_dt_s", std::isinf(largest_dt_s) ? Cell() : Cell(largest_dt_s)},
                 {"stable", scene.dt_s <= largest_dt_s},
                 {"backend", backend->name},
                 {"memory_bytes", bench_memory_needed(settings, size)},
                 {"bench_s", expected_time(settings, size).with(settings.rounds)},
                 {"run_s", expected_run_time(*backend, *integrator, size, steps)}});
    }
  }
  return table;
}

/// Default integrators of a bench.
std::vector<const Integrator*> usual_integrators() {
  return mapped<const Integrator*>(comparison_of_suite("").integrators, find_integrator);
}

/// A warning about the default integrators with which the scene may blow up, according to a limit on the safe
/// side. Empty if there is none.
std::string warning_of_dt(const PreparedScene& scene, const ModeBound& modes) {
  std::vector<std::string_view> unstable;
  double smallest = scene.dt_s;
  for (const Integrator* integrator : usual_integrators()) {
    if (is_garment(scene.system) && !dresses(*integrator)) continue;
    const double limit = largest_stable_dt(*integrator, modes);
    if (scene.dt_s <= limit) continue;
    unstable.push_back(integrator->name);
    smallest = std::min(smallest, limit);
  }
  if (unstable.empty()) return "";
  return fmt::format(
      "dt_s {:.3g} is above the stability limit of {}, with which the scene may blow up: give at most "
      "{:.3g}, or \"auto\"",
      scene.dt_s, listed(unstable), smallest);
}

/// A bench without --backend and --integrator holds all combinations in memory at once.
std::string warning_of_memory(const SceneSize& size) {
  const BenchSettings settings = usual_settings(comparison_of_suite("").backends(), usual_integrators());
  const auto shortage = memory_shortage(bench_memory_needed(settings, size));
  if (!shortage) return "";
  return fmt::format("a bench of all backends {}: name fewer with bench --backend or --integrator",
                     *shortage);
}

struct CheckOptions {
  std::vector<std::string> scenes;
  ListingFormat format = ListingFormat::table;
};

int run(const CheckOptions& options) {
  Table rows;          // each combination, with the properties of its scene
  std::string tables;  // for a reader: the properties of each scene on a line of their own
  for (const std::string& name : options.scenes) {
    const PreparedScene scene = prepare_scene(find_scene(name));
    const SceneSize size = size_of(scene.spec, scene.counts);
    const ModeBound modes = mode_bound(scene.system);
    const Table what = scene_table(scene), combinations = combination_table(scene, size, modes);
    for (const std::string& warning : {scene.note, warning_of_dt(scene, modes), warning_of_memory(size)})
      if (!warning.empty()) tell("{}: {}", scene.spec.name, warning);
    tables += (tables.empty() ? "" : "\n") + to_text(what) + '\n' + to_text(combinations);
    rows.columns = what.columns;
    std::ranges::copy(combinations.columns, std::back_inserter(rows.columns));
    for (const std::vector<Cell>& combination : combinations.rows)
      std::ranges::copy(combination, std::back_inserter(rows.rows.emplace_back(what.rows.front())));
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
