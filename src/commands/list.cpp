#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "application/bench/suites.h"
#include "application/choices.h"
#include "application/console.h"
#include "backends/accumulation/accumulation_methods.h"
#include "backends/backends.h"
#include "backends/described/backend_description.h"
#include "backends/devices/drivers.h"
#include "bench/results/result.h"
#include "commands/command.h"
#include "commands/options.h"
#include "integrators/all_integrators.h"
#include "output/folders/history_file.h"
#include "output/tables/results.h"
#include "report/report.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

struct ListOptions {
  std::string subject;
  ListingFormat format = ListingFormat::table;
  ExecutionOptions execution;
  OwnBackendOptions own_backends;
};

/// Lists scenes with the numbers that they really have. Bodies whose mesh cannot be made have none: TetGen
/// is missing, or a file is wrong. stderr gives the first reason only, because one cause explains all.
Table list_scenes(const ListOptions& /*options*/) {
  Table table;
  std::vector<std::string> uncounted;
  std::string first_reason;
  for (const SceneSpec& spec : shipped_scenes()) {
    std::optional<SceneCounts> counts;
    try {
      counts = counts_of(spec);
    } catch (const Error& reason) {
      if (uncounted.empty()) first_reason = reason.what();
      uncounted.push_back(spec.name);
    }
    table.add({{"scene", spec.name},
               {"kind", kind_of(spec).name},
               {"nodes", counts ? Cell(counts->nodes) : Cell()},
               {"springs_unique", counts ? Cell(counts->springs_unique) : Cell()},
               {"springs_published", counts ? Cell(counts->springs_published) : Cell()},
               {"dt_s", spec.dt_s ? Cell(*spec.dt_s) : Cell("auto")},
               {"description", spec.description}});
  }
  if (!uncounted.empty()) tell("nodes and springs of {} are not shown: {}", listed(uncounted), first_reason);
  return table;
}

/// The kinds of scenes that it steps: "cloth+bodies".
std::string steps_of(const BackendInfo& backend) {
  std::vector<std::string> kinds;
  if (steps_cloths(backend)) kinds.emplace_back("cloth");
  if (steps_bodies(backend)) kinds.emplace_back("bodies");
  if (dresses(backend)) kinds.emplace_back("garment");
  return join(kinds, "+");
}

Table list_backends(const ListOptions& options) {
  Table table;
  BackendChoice choice(with_garment_backends(table_backends()), options.own_backends);
  std::vector<std::string> broken;
  for (const BackendInfo* backend : every_backend(choice, broken)) {
    const std::string reason = unavailable_reason(*backend, options.execution);
    table.add({{"backend", backend->name},
               {"steps", steps_of(*backend)},
               {"paper_configuration", backend->paper_configuration},
               {"available", reason.empty()},
               {"description", backend->description},
               {"reason", reason.empty() ? Cell() : Cell(reason)}});
  }
  for (const std::string& reason : broken) tell("a backend is not shown: {}", reason);
  return table;
}

Table list_methods(const ListOptions& /*options*/) {
  Table table;
  for (const AccumulationMethod& method : accumulation_methods())
    table.add({{"method", method.backend.name},
               {"extra_memory", method.extra_memory},
               {"springs_computed", method.springs_computed},
               {"same_bits", name_of(method.repeatable)},
               {"description", method.backend.description}});
  return table;
}

Table list_suites(const ListOptions& /*options*/) {
  Table table;
  for (const Suite& suite : suites())
    table.add({{"suite", suite.name},
               {"timed", suite.timed},
               {"in_tables", suite.in_tables},
               {"scenes", listed(suite.scenes)},
               {"description", suite.description}});
  return table;
}

Table list_integrators(const ListOptions& /*options*/) {
  Table table;
  for (const Integrator* integrator : all_integrators)
    table.add({{"integrator", integrator->name},
               {"order", integrator->order},
               {"damped_order", integrator->damped_order},
               {"force_evaluations", is_implicit(*integrator) ? Cell() : Cell(integrator->stage_count)},
               {"description", integrator->description}});
  return table;
}

Table list_devices(const ListOptions& /*options*/) {
  Table table;
  for (const OpenclDevice& device : opencl_offer().devices)
    table.add({{"number", device.number},
               {"name", device.name},
               {"type", name_of(device.type)},
               {"platform", device.platform},
               {"driver", device.driver_version},
               {"compute_units", device.compute_units},
               {"memory_bytes", device.global_memory_bytes},
               {"float_width", device.float_width}});
  tell_of_opencl();
  if (opencl_offer().devices.empty() && opencl_offer().troubles.empty())
    tell("there is no OpenCL device here; Debian's pocl-opencl-icd makes the processor one");
  return table;
}

Table list_claims(const ListOptions& /*options*/) {
  Table table;
  for (const Claim& claim : published_claims())
    table.add({{"claim", claim.name},
               {"paper", claim.paper},
               {"place", claim.place},
               {"needs", claim.needs.empty() ? Cell() : Cell(claim.needs)},
               {"says", claim.says}});
  return table;
}

Table list_columns(const ListOptions& /*options*/) {
  Table table;
  for (const ResultColumn& column : result_columns)
    table.add({{"column", column.name},
               {"unit", column.unit.empty() ? Cell() : Cell(column.unit)},
               {"meaning", column.meaning}});
  return table;
}

/// The TABLE of what can be listed: a table, or the schema of a JSON file, which is printed as it is.
struct Listed {
  std::string_view name;
  Table (*list)(const ListOptions& options);
  std::string (*schema)() = nullptr;
};
constexpr auto subjects = std::to_array<Listed>({{"scenes", list_scenes},
                                                 {"suites", list_suites},
                                                 {"backends", list_backends},
                                                 {"methods", list_methods},
                                                 {"integrators", list_integrators},
                                                 {"devices", list_devices},
                                                 {"claims", list_claims},
                                                 {"columns", list_columns},
                                                 {"schema", nullptr, scene_schema},
                                                 {"claims-schema", nullptr, claims_schema},
                                                 {"backend-schema", nullptr, description_schema},
                                                 {"bench-schema", nullptr, bench_schema},
                                                 {"history-schema", nullptr, history_schema},
                                                 {"timings-schema", nullptr, timings_schema}});

int run_list(const ListOptions& options) {
  const Listed& subject = *found_in(subjects, options.subject, &Listed::name);
  const bool no_backends = subject.list != list_backends;
  refuse_options("list " + options.subject,
                 {{"--format", subject.schema && options.format != ListingFormat::table},
                  {"--device", no_backends && !options.execution.device.empty()},
                  {"--backend-folder", no_backends && !options.own_backends.folders.empty()}});
  require_use_of_options(options.execution, table_backends());
  std::cout << (subject.schema ? subject.schema() : to_text(subject.list(options), options.format));
  return exit_ok;
}

}  // namespace

std::function<int()> declare_list(Arguments& arguments) {
  const auto options = std::make_shared<ListOptions>();
  const auto known = mapped<std::string>(subjects, &Listed::name);
  arguments
      .add("WHAT", options->subject,
           "What to list: " + listed(known, "or") +
               "; a schema is a JSON Schema, that of scene files unless it is named after another file",
           one_of("word", known))
      .required();
  declare_listing_format(arguments, options->format);
  arguments.add(
      "--device N|NAME", options->execution.device,
      "With backends: OpenCL device to check them with, its number or a part of its name or platform");
  declare_backend_folders(arguments, options->own_backends);
  return [options] { return run_list(*options); };
}

}  // namespace mssim
