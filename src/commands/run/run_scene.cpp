#include "commands/run/run_scene.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "backends/reference.h"
#include "bench/estimates.h"
#include "commands/run/dressing_run.h"
#include "commands/shared/choices.h"
#include "commands/shared/opencl_notes.h"
#include "commands/shared/prepared_scene.h"
#include "commands/shared/progress_line.h"
#include "commands/shared/run_provenance.h"
#include "commands/shared/simulation.h"
#include "commands/shared/stop_request.h"
#include "garment/stepping/serial_dressing.h"
#include "output/tables/table.h"
#include "output/traces/energy_curve.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "scene/scene_file.h"
#include "text/error.h"

namespace mssim {
namespace {

/// Unless asked otherwise 60 frames a simulated second, or one a step where steps are longer.
double frames_per_second(const RunOptions& options, double dt_s) {
  return options.fps.value_or(std::min(60.0, 1 / dt_s));
}

PictureOptions pictures_of(const RunOptions& options) {
  return picture_options(options.look, usual_picture_size, complete(options.execution).threads);
}

/// The chosen backend, made by `in_single`, make_backend or make_dressing_backend, or by `in_double`.
template <class InSingle, class InDouble>
auto chosen_backend(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                    const Integrator& integrator, const InSingle& in_single, const InDouble& in_double) {
  if (options.precision == "single") {
    ExecutionOptions execution = complete(options.execution);
    execution.scene = scene.spec.name;
    execution.scene_file = scene.spec.file;
    auto backend = in_single(info, scene.system, integrator, scene.dt_s, execution);
    if (info.uses_device) tell_of_opencl();
    if (const std::string excess = excess_of(info, *backend, execution); !excess.empty())
      std::cerr << "mssim: " << options.backend << " runs " << excess << '\n';
    return backend;
  }
  if (info.name != "serial")
    throw UsageError(
        "--precision double needs --backend serial, not \"" + options.backend +
        "\": the other backends of mssim compute in single precision only, and a program in its own");
  return in_double(scene.system, integrator, scene.dt_s);
}

/// A garment is dressed until it has settled; --duration says how long that may take.
SettlingRule settling_rule(const RunOptions& options, const SimulationPlan& plan) {
  SettlingRule rule;
  if (options.duration_s) rule.longest_s = static_cast<double>(count_steps(plan)) * plan.dt_s;
  return rule;
}

/// Tells who waits long why.
void warn_of_slow_accounting(const SimulationPlan& plan, const System& system, const Integrator& integrator) {
  constexpr double passes_for_energies = 4;
  constexpr double springs_per_second = 1e8;  // of the double-precision reference, roughly
  constexpr double patience_s = 10;
  const double seconds = static_cast<double>(count_steps(plan)) * static_cast<double>(system.springs.size()) *
                         (passes_for_energies + expected_evaluations(integrator)) / springs_per_second;
  if (seconds > patience_s)
    std::cerr << "mssim: --losses takes a double-precision step for every step, about " << std::round(seconds)
              << " s in all\n";
}

/// What the three kinds of energy and the losses add up to at the end, less what they did at the start, over
/// the largest change that one kind of energy makes from frame to frame: zero in a perfect world.
std::optional<double> energy_imbalance(const std::vector<EnergySample>& curve, const EnergyLosses& losses) {
  double in_motion = 0;
  for (const auto kind : {&Energy::kinetic, &Energy::elastic, &Energy::gravitational}) {
    const auto [low, high] =
        std::ranges::minmax(curve, {}, [&](const EnergySample& sample) { return sample.energy.*kind; });
    in_motion = std::max(in_motion, high.energy.*kind - low.energy.*kind);
  }
  if (in_motion == 0) return std::nullopt;
  return (curve.back().energy.total() + losses.total() - curve.front().energy.total()) / in_motion;
}

FileHeaders headers_of(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                       const Backend& backend, const Integrator& integrator) {
  if (!options.files.any()) return {};
  Provenance provenance = run_provenance(backend.threads(), info.uses_device);
  add_programs(provenance, {&info}, complete(options.execution));
  add_scene(provenance, scene.spec.name, scene.spec.source);
  FileHeaders headers{trace_header(scene, backend, std::string(info.name), integrator, provenance),
                      command_line(provenance), pictures_of(options)};
  headers.trace.with_losses = options.losses;
  headers.trace.in_double = options.precision == "double";
  return headers;
}

int run_garment(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                const Integrator& integrator, const SimulationPlan& plan) {
  const auto backend =
      chosen_backend(options, info, scene, integrator, make_dressing_backend, make_reference_dressing);
  if (options.losses)
    throw UsageError(
        "--losses cannot be used with a garment: the work of its seams and contacts is not accounted for; "
        "leave it out");
  const FileHeaders headers = headers_of(options, info, scene, *backend, integrator);
  // After the headers, for which libraries are loaded that catch signals themselves, and before there is a
  // file.
  StopRequest stop;
  const FrameGrid frames = frame_grid(frames_per_second(options, scene.dt_s), scene.dt_s);
  const SettlingRule rule = settling_rule(options, plan);
  RunRecorder recorder(options.files, scene, headers);
  return run_dressing(scene, *backend, std::string(info.name), rule, frames, recorder, stop, options.silent);
}

int run_simulation(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                   const Integrator& integrator, const SimulationPlan& plan) {
  const auto in_double = [](const System& system, const Integrator& method, double dt_s) {
    return make_reference(system, method, dt_s);
  };
  const auto backend = chosen_backend(options, info, scene, integrator, make_backend, in_double);
  const FileHeaders headers = headers_of(options, info, scene, *backend, integrator);
  StopRequest stop;  // where run_garment has it
  RunRecorder recorder(options.files, scene, headers);
  if (plan.accounts_for_losses) warn_of_slow_accounting(plan, scene.system, integrator);
  std::int64_t steps = 0;
  std::optional<EnergyLosses> losses;
  double seconds = 0;
  recorder.finish_after([&] {
    const Stopwatch watch;
    ProgressLine progress({1}, ProgressLine::Log::nothing);
    progress.begin_scene(scene.spec.name);
    simulate(*backend, scene.system, integrator, plan,
             {[&](const Frame& frame) {
                recorder.record(frame);
                steps = frame.step;
                losses = frame.losses;
                stop.throw_if_requested();
              },
              [&](std::int64_t done, std::int64_t all) {
                progress.update_often("step " + std::to_string(done) + " of " + std::to_string(all),
                                      static_cast<double>(done) / static_cast<double>(all));
                stop.throw_if_requested();
              }});
    seconds = watch.seconds();
  });

  const std::vector<EnergySample>& curve = recorder.energies();
  const auto loss = [&](double EnergyLosses::*kind) { return losses ? Cell(*losses.*kind) : Cell(); };
  const Energy &first = curve.front().energy, &last = curve.back().energy;
  Table table;
  table.add({{"scene", scene.spec.name},
             {"backend", info.name},
             {"device", backend->device()},
             {"threads", backend->threads()},
             {"integrator", options.integrator},
             {"dt_s", scene.dt_s},
             {"steps", steps},
             {"simulated_s", curve.back().time_s},
             {"wall_s", seconds},
             {"kinetic_j", last.kinetic},
             {"elastic_j", last.elastic},
             {"gravitational_j", last.gravitational},
             {"total_change_j", last.total() - first.total()},
             {"damping_loss_j", loss(&EnergyLosses::damping)},
             {"friction_loss_j", loss(&EnergyLosses::friction)},
             {"bounce_loss_j", loss(&EnergyLosses::bounce)},
             {"integration_loss_j", loss(&EnergyLosses::integration)},
             {"energy_imbalance", losses ? Cell(energy_imbalance(curve, *losses)) : Cell()}});
  if (!options.silent) std::cout << record_text(table, terminal_of(STDOUT_FILENO).width);
  return exit_ok;
}

}  // namespace

int run_scene(RunOptions options) {
  const auto require_trace_name = [&] {
    if (options.files.trace.empty()) return;
    if (const auto problem = trace_name_problem(options.files.trace))
      throw UsageError("--trace: " + *problem);
  };
  require_trace_name();
  for (std::string* file : {&options.files.trace, &options.files.energy_curve})
    if (!file->empty()) *file = target_of(*file).string();
  require_trace_name();
  pictures_of(options);  // refuses what cannot be drawn
  const Integrator& integrator = require_integrator(options.integrator);
  BackendChoice choice(table_backends(), options.own_backends, {options.scene});
  const BackendInfo& info = choice.require(options.backend);
  require_use_of_ranks(options.execution, {&info});
  PreparedScene scene = prepare_scene(find_scene(options.scene));
  warn_of_note(scene);
  require_distinct(options.files, scene.spec);
  if (options.dt_s) scene.dt_s = *options.dt_s;
  const SimulationPlan plan{scene.dt_s, options.duration_s.value_or(default_duration_s),
                            frames_per_second(options, scene.dt_s), options.losses};
  return is_garment(scene.system) ? run_garment(options, info, scene, integrator, plan)
                                  : run_simulation(options, info, scene, integrator, plan);
}

void declare_stepping(Arguments& arguments, RunOptions& options, const std::string& about_fps,
                      std::optional<Argument> needed) {
  const auto of_a_simulation = [&](Argument argument, const std::string& value_name) {
    argument.value_name(value_name);
    if (needed) argument.needs(*needed);
  };
  of_a_simulation(
      arguments.add("--backend", options.backend,
                    "Backend that simulates it: a name (see mssim list backends), or a program of "
                    "your own, a path with a slash (default: openmp)"),
      "NAME|FILE");
  of_a_simulation(declare_backend_folders(arguments, options.own_backends), "DIR,...");
  of_a_simulation(declare_backend_limit(arguments, options.own_backends), "SECONDS");
  of_a_simulation(arguments.add("--integrator", options.integrator, "Integrator (default: semi-euler)"),
                  "NAME");
  of_a_simulation(
      arguments.add_number("--duration", options.duration_s,
                           "Simulated time (default: 1); for a garment the longest time that it may take to "
                           "settle (default: 4)",
                           positive_number()),
      "SECONDS");
  arguments.add_number("--fps", options.fps, about_fps, positive_number()).value_name("N");
  of_a_simulation(
      arguments.add_number("--dt", options.dt_s, "Time of a step (default: the scene's)", positive_number()),
      "SECONDS");
  declare_execution(arguments, options.execution);
}

}  // namespace mssim
