#include "guide/limits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "integrators/stability.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr double worth_a_word = 1.1;
constexpr std::size_t few_runs = 5;  // of which the fastest is taken

/// Thrown for a backend whose times mean nothing here; what() is its reason.
struct NotTimed : ErrorWith<exit_unavailable> {
  using ErrorWith::ErrorWith;
};

std::string percent_more(double ratio) { return three_digits(100 * (ratio - 1)) + " %"; }

/// Whether theory's step is longer by so much that the page explains it.
bool is_shorter_than_theory(const StableStep& measured, const StepTheory& theory) {
  return measured.unstable_s > 0 && measured.stable_s * worth_a_word < theory.shortest_s();
}

/// A typical step of explicit methods: the limit of semi-implicit Euler by theory.
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

/// Shortens runs to the available time: about eight of them find a limit. False if there is no time for one
/// run.
bool fit(StepSearch& search, double seconds_a_step, double seconds) {
  constexpr int runs = 8, fewest_steps = 10;
  const double steps = seconds / runs / seconds_a_step;
  search.least_steps = static_cast<int>(std::clamp<double>(steps, fewest_steps, search.least_steps));
  search.span_s = std::min(search.span_s, std::max(steps, 10.0 * fewest_steps) * search.first_s);
  return runs * steps >= fewest_steps;
}

/// Throws BackendFailure if a few of the shortest steps that were tried are unstable on the backend but not
/// in the reference.
void require_sound_steps(const StepMaker& make, StepSearch search, const LimitRequest& request,
                         const StepLimit& limit) {
  search.span_s = 0;
  const double dt_s = limit.measured.unstable_s;
  if (!is_stable(*make(dt_s), *request.system, dt_s, search) &&
      is_stable(*make_reference(*request.system, *limit.integrator, dt_s, request.stop), *request.system,
                dt_s, search))
    throw BackendFailure(
        fmt::format("its energy grows or is not finite even with a step of {} s, unlike the reference's",
                    two_digits(dt_s)),
        "");
}

/// Finds the limit with this backend. Throws the backend's failures.
void find_with(const BackendInfo& info, StepSearch search, const LimitRequest& request, StepLimit& limit) {
  const Integrator& integrator = *limit.integrator;
  const Stopwatch watch;
  const StepMaker make = [&](double dt_s) {
    return make_backend(info, *request.system, integrator, dt_s, request.execution);
  };
  const auto backend = make(search.first_s);
  limit.backend = info.name;
  limit.first_seconds = watch.seconds();
  limit.step_seconds = seconds_of_step(*backend, *request.system);
  if (!fit(search, limit.step_seconds, request.seconds)) {
    limit.measured.finished = false;
    return;
  }
  limit.measured = largest_stable_step(*request.system, make, search);
  if (limit.lack() == Lack::stable_step) require_sound_steps(make, search, request, limit);
  if (is_shorter_than_theory(limit.measured, limit.theory)) {
    const System in_the_air = without_floor(*request.system);
    const double dt_s = limit.measured.unstable_s;
    // Processes that read the scene's file would find the floor there.
    const bool reads_scene = info.program != nullptr && info.program->in_ranks;
    const BackendInfo& floorless = reads_scene ? best_host_backend() : info;
    // Energies count from the floor's real height: from that of in_the_air, all others would be lost in
    // rounding.
    limit.floor_is_why = is_stable(*make_backend(floorless, in_the_air, integrator, dt_s, request.execution),
                                   *request.system, dt_s, search);
  }
  limit.why = why_they_differ(integrator, limit.measured, limit.theory, limit.floor_is_why);
}

}  // namespace

double energy_bound(const System& system, double span_s) {
  const Energy start = energy_of(system, system.start);
  double mass = 0;
  for (const double node : system.node_mass) mass += node;
  const double fall = 0.5 * mass * system.gravity * system.gravity * span_s * span_s;
  const double given = std::min(fall, std::max(0.0, start.gravitational));
  // Of a scene at rest, roundings alone make energy.
  const double of_roundings = energy_in_motion(system, system.start, Energy{});
  return start.total() +
         std::max(allowed_energy_growth * (start.kinetic + start.elastic + given), of_roundings);
}

bool stays_below(Backend& backend, const System& system, int steps, double bound_j) {
  constexpr int looks = 30;
  backend.set_state(system.start);
  for (int look = 0, done = 0; look < looks; ++look) {
    const int until = static_cast<int>(static_cast<long long>(steps) * (look + 1) / looks);
    if (until == done) continue;
    backend.step(until - done);
    done = until;
    const State state = backend.state();
    if (first_bad_node(state) || !(energy_of(system, state).total() <= bound_j)) return false;
  }
  return true;
}

bool is_stable(Backend& backend, const System& system, double dt_s, const StepSearch& search) {
  const int steps = std::max(search.least_steps, static_cast<int>(std::ceil(search.span_s / dt_s)));
  return stays_below(backend, system, steps, energy_bound(system, steps * dt_s));
}

StableStep largest_stable_step(const System& system, const StepMaker& make, const StepSearch& search) {
  constexpr double first_stride = 1.5;
  StableStep found;
  found.span_s = search.span_s;
  const auto try_step = [&](double dt_s) {
    ++found.runs;
    const bool stable = is_stable(*make(dt_s), system, dt_s, search);
    (stable ? found.stable_s : found.unstable_s) = dt_s;
    return stable;
  };
  double dt_s = std::clamp(search.first_s, search.shortest_s, search.longest_s);
  const bool first_is_stable = try_step(dt_s);
  // Away from the first step until a stable and an unstable step are known.
  for (double stride = first_stride; found.stable_s == 0 || found.unstable_s == 0; stride *= first_stride) {
    const double next =
        std::clamp(first_is_stable ? dt_s * stride : dt_s / stride, search.shortest_s, search.longest_s);
    if (next == dt_s) return found;
    if (search.stop()) {
      found.finished = false;
      return found;
    }
    dt_s = next;
    try_step(dt_s);
  }
  while (found.unstable_s > step_resolution * found.stable_s) {
    if (search.stop() || search.hurry()) {
      found.finished = false;
      break;
    }
    try_step(std::sqrt(found.stable_s * found.unstable_s));
  }
  return found;
}

StepTheory step_theory(const Integrator& integrator, const System& system, const Spectrum& start,
                       const Spectrum& reached) {
  ModeBound modes = mode_bound(system);
  const double bound_s = largest_stable_dt(integrator, modes);
  const auto limit_of = [&](const Spectrum& spectrum) {
    modes.stiffness = spectrum.stiffness;
    modes.damping = spectrum.damping;
    return largest_stable_dt(integrator, modes);
  };
  return {limit_of(start), limit_of(reached), bound_s};
}

std::string why_they_differ(const Integrator& integrator, const StableStep& measured,
                            const StepTheory& theory, bool floor_is_why) {
  if (measured.stable_s == 0 && !measured.finished) return "no time was left to find the limit";
  if (is_shorter_than_theory(measured, theory) && floor_is_why)
    return "the floor: a node that ends a step below it is moved onto it, which strains the node's springs, "
           "and more so with longer steps; without the floor longer steps are stable";
  if (is_implicit(integrator)) {
    if (measured.unstable_s == 0) return {};
    return "backward Euler damps every linear mode with every step; solvers that stop before convergence, "
           "and springs that fold, are not linear";
  }
  const double limit = theory.shortest_s();
  if (limit == 0 && measured.stable_s == 0) return {};
  if (limit == 0)
    return "theory finds modes that grow with every step, those that only the air damps; below the measured "
           "step they grow so slowly that a run of " +
           three_digits(measured.span_s) + " s does not show it; a longer run needs shorter steps";
  if (measured.stable_s == 0) return "no step that was tried was stable, but theory has one";
  if (measured.stable_s > worth_a_word * limit) {
    std::string why = "the measured step is " + percent_more(measured.stable_s / limit) + " longer: ";
    if (theory.on_the_way_s < limit * 1.0001 && theory.on_the_way_s * worth_a_word < theory.at_start_s)
      return why +
             "the strained state for which theory computes it has stiffer modes (springs stiffen sideways), "
             "but for too short a time for a run to blow up";
    return why +
           "theory counts a growth of one part in a million per step, which the undamped sideways modes "
           "reach first; a run shows only faster growth";
  }
  if (is_shorter_than_theory(measured, theory))
    return "the measured step is " + percent_more(limit / measured.stable_s) +
           " shorter: springs that strain during the run stiffen sideways, where they have no damping";
  return {};
}

std::string Ending::status() const {
  const std::string word = lack == Lack::unsupported   ? "unsupported: "
                           : lack == Lack::unavailable ? "unavailable: "
                           : lack == Lack::not_timed   ? "not timed: "
                           : lack == Lack::failed      ? "failed: "
                                                       : "";
  return word + why;
}

Ending ending_of(const std::function<void()>& work) {
  const Stopwatch watch;
  try {
    work();
    return {};
  } catch (const Unsupported& reason) {
    return {Lack::unsupported, reason.what()};
  } catch (const Unavailable& reason) {
    return {Lack::unavailable, reason.what()};
  } catch (const NotTimed& reason) {
    return {Lack::not_timed, reason.what()};
  } catch (const BackendFailure& reason) {
    return {Lack::failed, reason.what(), reason.late ? watch.seconds() : 0};
  }
}

std::unique_ptr<Backend> make_timed_backend(const BackendInfo& info, const System& system,
                                            const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& execution) {
  auto backend = make_backend(info, system, integrator, dt_s, execution);
  if (const std::string reason = backend->reason_not_to_time(); !reason.empty()) throw NotTimed(reason);
  return backend;
}

StepTime time_steps(Backend& backend, const System& system, int steps, double enough_s) {
  constexpr std::size_t many = 100;
  const auto run = [&](int count) {
    backend.set_state(system.start);
    const Stopwatch watch;
    backend.step(count);
    return watch.seconds();
  };
  constexpr int first_steps = 10;
  const double first = run(std::min(steps, first_steps));  // touches memory and starts threads
  if (steps <= first_steps && first >= 10 * enough_s) return {first / steps, 1};
  std::vector<double> seconds;
  double sum = 0;
  do {
    seconds.push_back(run(steps));
    sum += seconds.back();
  } while (seconds.size() < many && (sum < enough_s || (seconds.size() < few_runs && sum < 10 * enough_s)));
  return {std::ranges::min(seconds) / steps, static_cast<int>(seconds.size())};
}

double seconds_of_runs(double run_s, double enough_s) {
  return std::max(run_s, std::clamp(few_runs * run_s, enough_s, 10 * enough_s));
}

double seconds_of_step(Backend& backend, const System& system) {
  constexpr int trial_steps = 5;
  constexpr double enough_s = 0.01;
  const double one = time_steps(backend, system, 1, enough_s / 10).seconds;
  return one > enough_s ? one : time_steps(backend, system, trial_steps, enough_s).seconds;
}

StepLimit find_step_limit(const Integrator& integrator, const LimitRequest& request) {
  StepLimit limit;
  limit.integrator = &integrator;
  limit.theory = step_theory(integrator, *request.system, request.at_start, request.on_the_way);
  const StepSearch search = search_for(integrator, limit.theory, request);
  std::vector<const BackendInfo*> order = request.backends;
  std::stable_partition(order.begin(), order.end(),
                        [](const BackendInfo* info) { return info->role == BackendRole::best_of_host; });
  for (const BackendInfo* info : order) {
    StepLimit found = limit;
    const Ending ending = ending_of([&] { find_with(*info, search, request, found); });
    if (ending.lack == Lack::nothing) {
      found.ending = {};
      return found;
    }
    if (ending.late_s > 0) limit.late.push_back({info, ending});
    if (limit.ending.lack == Lack::nothing) limit.ending = ending;
  }
  return limit;
}

}  // namespace mssim
