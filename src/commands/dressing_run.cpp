#include "commands/dressing_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <vector>

#include "bench/blow_up.h"
#include "commands/exit_code.h"
#include "commands/fit_body.h"
#include "commands/stop_request.h"
#include "fitting/fit_bounds.h"
#include "output/listing.h"

namespace mssim {
int run_dressing(const PreparedScene& scene, DressingBackend& backend, const std::string& backend_name) {
  StopRequest stop;
  const auto before = std::chrono::steady_clock::now();
  const DressingResult result =
      dress(backend, scene.system, scene.dt_s, {}, [&](const State& state, std::int64_t iterations) {
        if (const auto node = first_bad_node(state))
          throw NotVerified("the simulation blew up before step " + std::to_string(iterations) + ": node " +
                            std::to_string(*node) + " is not finite");
        stop.throw_if_requested();
        return true;
      });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  const Fit fit = fit_of(scene.system, result.state.position, fit_body(scene.spec));
  nlohmann::ordered_json row{
      {"scene", scene.spec.name},
      {"backend", backend_name},
      {"threads", backend.threads()},
      {"nodes", scene.system.nodes()},
      {"dt_s", scene.dt_s},
      {"seamed_at", result.seamed_at ? nlohmann::ordered_json(*result.seamed_at) : nlohmann::ordered_json()},
      {"iterations", result.iterations},
      {"simulated_s", result.simulated_s},
      {"wall_s", seconds},
      {"ms_per_iteration", 1e3 * seconds / static_cast<double>(result.iterations)}};
  for (const FitCheck& check : fit_checks(fit, {})) row[check.name] = check.value;
  std::cout << to_text({row}, ListingFormat::table);
  const std::vector<std::string> found = misfits(result, fit, {});
  for (const std::string& misfit : found) std::cerr << "mssim: " << scene.spec.name << ": " << misfit << '\n';
  return found.empty() ? exit_ok : exit_not_verified;
}

}  // namespace mssim
