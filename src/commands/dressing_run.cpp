#include "commands/dressing_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <vector>

#include "bench/blow_up.h"
#include "commands/exit_code.h"
#include "commands/stop_request.h"
#include "contact/solid.h"
#include "fitting/fit_bounds.h"
#include "garment/body_profile.h"
#include "output/listing.h"
#include "scene/garment.h"

namespace mssim {
namespace {

/// The middle of the leg on the point's side, or of the trunk where that is nearer.
Vec3d limb_middle(const BodyProfile& profile, const Vec3d& point) {
  if (profile.has_legs()) {
    const PlanPoint leg = profile.leg_middle(point.y);
    if (std::abs(point.x) > leg.x / 2) return {point.x < 0 ? -leg.x : leg.x, point.y, leg.z};
  }
  const double height = std::clamp(point.y, profile.lowest(), profile.highest());
  return {0, point.y, (profile.front(height) + profile.back(height)) / 2};
}

Fit measured_fit(const PreparedScene& scene, const State& state) {
  const Surface surface = body_of_garment(scene.spec);
  const Solid solid(surface);
  const BodyProfile profile(surface);
  return fit_of(scene.system, state.position,
                {[&](std::span<const Vec3d> points) { return solid.depths(points); },
                 [&](const Vec3d& point) { return limb_middle(profile, point); }});
}

}  // namespace

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
  const Fit fit = measured_fit(scene, result.state);
  std::cout << to_text({{{"scene", scene.spec.name},
                         {"backend", backend_name},
                         {"threads", backend.threads()},
                         {"nodes", scene.system.nodes()},
                         {"dt_s", scene.dt_s},
                         {"seamed_at", result.seamed_at ? nlohmann::ordered_json(*result.seamed_at)
                                                        : nlohmann::ordered_json()},
                         {"iterations", result.iterations},
                         {"simulated_s", result.simulated_s},
                         {"wall_s", seconds},
                         {"ms_per_iteration", 1e3 * seconds / static_cast<double>(result.iterations)},
                         {"largest_gap_mm", 1e3 * fit.largest_gap},
                         {"nodes_inside", fit.nodes_inside},
                         {"deepest_node_mm", 1e3 * fit.deepest_node},
                         {"deepest_face_mm", 1e3 * fit.deepest_face_sample},
                         {"elongation_50", fit.elongation_50},
                         {"elongation_99", fit.elongation_99},
                         {"elongation_999", fit.elongation_999},
                         {"elongation_max", fit.elongation_max},
                         {"upper_edge_rise_mm", 1e3 * fit.upper_edge_rise},
                         {"crotch_rise_mm", 1e3 * fit.meeting_rise},
                         {"rows", fit.rows},
                         {"rows_astray", fit.rows_astray},
                         {"crossings", fit.crossings}}},
                       ListingFormat::table);
  const std::vector<std::string> found = misfits(result, fit, {});
  for (const std::string& misfit : found) std::cerr << "mssim: " << scene.spec.name << ": " << misfit << '\n';
  return found.empty() ? exit_ok : exit_not_verified;
}

}  // namespace mssim
