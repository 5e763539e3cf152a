#include "commands/run_command.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "backends/serial.h"
#include "commands/choices.h"
#include "commands/exit_code.h"
#include "commands/prepared_scene.h"
#include "commands/run_provenance.h"
#include "commands/simulation.h"
#include "output/energy_curve.h"
#include "output/h5md_trace.h"
#include "output/listing.h"

namespace mssim {
namespace {

struct RunOptions {
  std::string scene;
  std::string backend = "openmp";
  std::string integrator = "semi-euler";
  std::string precision = "single";
  std::optional<double> dt_s;
  double duration_s = 1;
  double fps = 60;
  std::string trace;
  std::string energy_curve;
  ExecutionOptions execution;
};

std::unique_ptr<Backend> make_backend(const RunOptions& options, const PreparedScene& scene,
                                      const Integrator& integrator) {
  const BackendInfo& info = require_backend(options.backend);
  if (options.precision == "single")
    return info.make(scene.system, integrator, scene.dt_s, complete(options.execution));
  if (info.make != make_serial)
    throw UsageError("--precision double needs --backend serial, not \"" + options.backend +
                     "\": the other backends compute in single precision only");
  return make_reference(scene.system, integrator, scene.dt_s);
}

int run(const RunOptions& options) {
  const Integrator& integrator = require_integrator(options.integrator);
  require_backend(options.backend);
  PreparedScene scene = prepare_scene(options.scene);
  if (options.dt_s) scene.dt_s = *options.dt_s;
  const auto backend = make_backend(options, scene, integrator);

  std::optional<H5mdTrace> trace;
  if (!options.trace.empty())
    trace.emplace(options.trace, scene.system, trace_header(scene, *backend, options.backend, integrator));
  std::vector<EnergySample> curve;
  std::int64_t steps = 0;
  const auto before = std::chrono::steady_clock::now();
  const auto finish = [&] {
    if (trace) trace->close();
  };
  try {
    simulate(*backend, scene.system, {scene.dt_s, options.duration_s, options.fps},
             [&](std::int64_t step, double time_s, const State& state, const Energy& energy) {
               if (trace) trace->write_frame(step, time_s, state, energy);
               curve.push_back({time_s, energy});
               steps = step;
             });
  } catch (const NotVerified&) {
    finish();  // the frames before it are good and show what happened
    throw;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  finish();
  if (!options.energy_curve.empty()) write_energy_curve(options.energy_curve, curve, command_line());

  const Energy &first = curve.front().energy, &last = curve.back().energy;
  std::cout << to_text({{{"scene", scene.spec.name},
                         {"backend", options.backend},
                         {"device", backend->device()},
                         {"integrator", options.integrator},
                         {"dt_s", scene.dt_s},
                         {"steps", steps},
                         {"simulated_s", curve.back().time_s},
                         {"wall_s", seconds},
                         {"kinetic_j", last.kinetic},
                         {"elastic_j", last.elastic},
                         {"gravitational_j", last.gravitational},
                         {"total_change_j", last.total() - first.total()}}},
                       ListingFormat::table);
  return exit_ok;
}

}  // namespace

std::function<int()> declare_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  app.add_option("--scene", options->scene, "Scene: a name (see mssim list scenes) or a file")->required();
  app.add_option("--backend", options->backend, "Backend (default: openmp)");
  app.add_option("--integrator", options->integrator, "Integrator (default: semi-euler)");
  app.add_option("--duration", options->duration_s, "Simulated seconds (default: 1)")
      ->check(positive_number());
  app.add_option("--fps", options->fps, "Frames per simulated second (default: 60)")
      ->check(positive_number());
  app.add_option("--dt", options->dt_s, "Step in seconds (default: the scene's)")->check(positive_number());
  app.add_option("--precision", options->precision,
                 "single, or double with --backend serial (default: single)")
      ->check(CLI::IsMember({"single", "double"}));
  app.add_option("--trace", options->trace, "Write an H5MD trace to this .h5 file, and an .xdmf beside it");
  app.add_option("--energy-curve", options->energy_curve,
                 "Write the energies of all frames to this CSV file");
  declare_execution(app, options->execution);
  return [options] { return run(*options); };
}

}  // namespace mssim
