#include "commands/run/dressing_run.h"

#include <unistd.h>

#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <vector>

#include "bench/verification/verification.h"
#include "commands/shared/fit_body.h"
#include "commands/shared/progress_line.h"
#include "garment/fitting/fitting.h"
#include "output/tables/table.h"
#include "platform/machine.h"
#include "text/error.h"

namespace mssim {

int run_dressing(const PreparedScene& scene, DressingBackend& backend, const std::string& backend_name,
                 const SettlingRule& rule, const FrameGrid& frames, RunRecorder& recorder, StopRequest& stop,
                 bool silent) {
  const auto require_finite = [](const State& state, std::int64_t iterations) {
    if (const auto node = first_bad_node(state))
      throw NotVerified("the simulation blew up before step " + std::to_string(iterations) + ": node " +
                        std::to_string(*node) + " is not finite");
  };
  const auto record = [&](const State& state, std::int64_t iterations) {
    require_finite(state, iterations);
    recorder.record({iterations, static_cast<double>(iterations) * scene.dt_s, state,
                     energy_of(scene.system, state), std::nullopt});
    stop.throw_if_requested();
  };
  DressingResult result;
  double seconds = 0;
  recorder.finish_after([&] {
    const Stopwatch watch;
    ProgressLine progress({1}, ProgressLine::Log::nothing);
    progress.begin_scene(scene.spec.name);
    progress.update("closing seams", 0);
    result = dress(
        backend, scene.system, scene.dt_s, rule,
        [&](const State& state, std::int64_t iterations) {
          require_finite(state, iterations);
          stop.throw_if_requested();
          std::ostringstream activity;
          activity << (backend.progress().draping ? "draping" : "closing seams") << ", " << std::fixed
                   << std::setprecision(2) << static_cast<double>(iterations) * scene.dt_s
                   << " s simulated of at most " << rule.longest_s;
          progress.update(activity.str(), 0);  // when it will have settled, nobody knows
          return true;
        },
        recorder.wanted() ? DressingFrames{frames, record} : DressingFrames{});
    seconds = watch.seconds();
  });
  const Fit fit = fit_of(scene.system, result.state.position, fit_body(scene.body));
  Table dressing, fitting;
  dressing.add({{"scene", scene.spec.name},
                {"backend", backend_name},
                {"threads", backend.threads()},
                {"nodes", scene.system.nodes()},
                {"dt_s", scene.dt_s},
                {"seamed_at", result.seamed_at},
                {"iterations", result.iterations},
                {"simulated_s", result.simulated_s},
                {"wall_s", seconds},
                {"ms_per_iteration", 1e3 * seconds / static_cast<double>(result.iterations)}});
  for (const FitCheck& check : fit_checks(fit, {}))
    fitting.add({{"fit", check.name},
                 {"value", check.value},
                 {"bound", check.bound ? Cell(check.shown_bound) : Cell()},
                 {"within", check.within}});
  if (!silent)
    std::cout << record_text(dressing, terminal_of(STDOUT_FILENO).width) << '\n' << to_text(fitting);
  if (!result.settled && rule.longest_s < SettlingRule{}.longest_s)
    std::cerr << "mssim: " << scene.spec.name << ": after " << result.simulated_s
              << " s the garment is still moving; a longer --duration gives it more time\n";
  const std::vector<std::string> found = misfits(result, fit, {});
  for (const std::string& misfit : found) std::cerr << "mssim: " << scene.spec.name << ": " << misfit << '\n';
  return found.empty() ? exit_ok : exit_not_verified;
}

}  // namespace mssim
