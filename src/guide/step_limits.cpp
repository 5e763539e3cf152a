#include "guide/step_limits.h"

#include <algorithm>
#include <cmath>

#include "guide/step_timer.h"
#include "guide/work_precision.h"
#include "integrators/integrators.h"
#include "platform/machine.h"

namespace mssim {
namespace {

/// A step that the explicit methods are near to: the limit of semi-implicit Euler in the same theory.
double usual_limit(const LimitRequest& request) {
  const double limit =
      step_theory(integrators[0], *request.system, request.at_start, request.on_the_way).shortest_s();
  return std::isfinite(limit) && limit > 0 ? std::min(limit, longest_useful_step_s) : longest_useful_step_s;
}

StepSearch search_for(const Integrator& integrator, const StepTheory& theory, const LimitRequest& request) {
  constexpr double depth = 64;  // how far below the usual limit an explicit step is tried
  const double usual = usual_limit(request), limit = theory.shortest_s();
  StepSearch search;
  search.longest_s = longest_useful_step_s;
  search.shortest_s = usual / depth;
  search.first_s = is_implicit(integrator) ? search.longest_s
                   : limit > 0             ? std::min(limit, search.longest_s)
                                           : usual;
  search.span_s = stability_span_s;
  search.stop = request.stop;
  search.hurry = [watch = Stopwatch(), seconds = request.seconds] { return watch.seconds() > seconds; };
  return search;
}

/// Wall time of a step.
double step_seconds(Backend& backend, const System& system) {
  constexpr int trial_steps = 5;
  constexpr double enough_s = 0.01;
  const double one = time_steps(backend, system, 1, enough_s / 10).seconds;
  return one > enough_s ? one : time_steps(backend, system, trial_steps, enough_s).seconds;
}

/// Shortens runs to what there is time for: some eight of them find a limit. False if not even one run ends
/// in it.
bool fit(StepSearch& search, double seconds_a_step, double seconds) {
  constexpr int runs = 8, fewest_steps = 10;
  const double steps = seconds / runs / seconds_a_step;
  search.least_steps = static_cast<int>(std::clamp<double>(steps, fewest_steps, search.least_steps));
  search.span_s = std::min(search.span_s, std::max(steps, 10.0 * fewest_steps) * search.first_s);
  return runs * steps >= fewest_steps;
}

/// Finds the limit with this backend, whose failures it throws.
void find_with(const BackendInfo& info, StepSearch search, const LimitRequest& request, StepLimit& limit) {
  const Integrator& integrator = *limit.integrator;
  const Stopwatch watch;
  const StepMaker make = [&](double dt_s) {
    return make_backend(info, *request.system, integrator, dt_s, request.execution);
  };
  const auto backend = make(search.first_s);
  limit.backend = info.name;
  limit.first_seconds = watch.seconds();
  limit.step_seconds = step_seconds(*backend, *request.system);
  if (!fit(search, limit.step_seconds, request.seconds)) {
    limit.measured.finished = false;
    return;
  }
  limit.measured = largest_stable_step(*request.system, make, search);
  if (is_shorter_than_theory(limit.measured, limit.theory)) {
    const System in_the_air = without_floor(*request.system);
    const double dt_s = limit.measured.unstable_s;
    // Processes that read the scene's file would find the floor there.
    const bool reads_scene = info.program != nullptr && info.program->in_ranks;
    const BackendInfo& floorless = reads_scene ? *find_backend("openmp") : info;
    limit.floor_is_why = is_stable(*make_backend(floorless, in_the_air, integrator, dt_s, request.execution),
                                   in_the_air, dt_s, search);
  }
  limit.why = why_they_differ(integrator, limit.measured, limit.theory, limit.floor_is_why);
}

}  // namespace

StepLimit find_step_limit(const Integrator& integrator, const LimitRequest& request) {
  StepLimit limit;
  limit.integrator = &integrator;
  limit.theory = step_theory(integrator, *request.system, request.at_start, request.on_the_way);
  const StepSearch search = search_for(integrator, limit.theory, request);
  std::vector<const BackendInfo*> order = request.backends;
  std::stable_partition(order.begin(), order.end(),
                        [](const BackendInfo* info) { return info->name == "openmp"; });
  for (const BackendInfo* info : order) {
    StepLimit found = limit;
    std::string status;
    if (succeeds(*info, status, limit.late, [&] { find_with(*info, search, request, found); })) {
      found.status.clear();
      found.late = limit.late;
      return found;
    }
    if (limit.status.empty()) limit.status = status;
  }
  return limit;
}

}  // namespace mssim
