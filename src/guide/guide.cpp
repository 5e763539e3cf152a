#include "guide/guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "guide/ranking.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Fractions of the wall time. A part that ends early leaves its time to the next. One that takes longer does
/// not shorten the others: on a busy machine the whole guide takes longer.
constexpr double share_of_trust = 0.2, share_of_limits = 0.2, until_limits = 0.45, share_of_points = 0.3,
                 share_of_longest_steps = 0.05, share_of_sizes = 0.2, share_of_exact_steps = 0.1;

/// The clock of a guide.
class GuideClock {
 public:
  explicit GuideClock(double seconds) : seconds_(seconds) {}
  double spent() const { return watch_.seconds() - forgiven_; }
  /// Does not count the time lost in waiting for a program that was late.
  void forgive(const Ending& ending) { forgiven_ += ending.late_s; }
  double fraction() const { return std::min(1.0, spent() / seconds_); }
  /// End of a part that starts now, in seconds of this clock, with the fraction `later` left for the
  /// following parts.
  double end_of_part(double share, double later) const {
    return std::max(spent() + share * seconds_, (1 - later) * seconds_);
  }

 private:
  double seconds_, forgiven_ = 0;
  Stopwatch watch_;
};

void find_trusted_state(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch) {
  const double limit =
      step_theory(*find_integrator("rk4"), *request.system, guide.at_start, guide.at_start).at_start_s;
  // A third of the stability limit of rk4 by theory: there, the order of its error is 4.
  const double first_dt_s = std::isfinite(limit) && limit > 0 ? limit / 3 : request.longest_horizon_s / 100;
  guide.trusted = trusted_state(*request.system, {.longest_s = request.longest_horizon_s,
                                                  .first_dt_s = first_dt_s,
                                                  .seconds = share_of_trust * request.seconds,
                                                  .stop = watch.stop});
}

void find_limits(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch, GuideClock& clock) {
  constexpr double patience = 1.5;  // multiple of its time that an integrator may take to find a stable step
  LimitRequest limits{.system = request.system,
                      .backends = request.backends,
                      .execution = request.execution,
                      .at_start = guide.at_start,
                      .on_the_way = guide.on_the_way};
  const double end = clock.end_of_part(share_of_limits, 1 - until_limits);
  Ending given_up;  // why there is no backend left
  for (std::size_t i = 0; i < request.integrators.size(); ++i) {
    const Integrator& integrator = *request.integrators[i];
    watch.progress("largest stable step: " + std::string(integrator.name), clock.fraction());
    if (watch.stop()) return;
    const double begin = clock.spent();
    limits.seconds = std::max(0.0, end - begin) / static_cast<double>(request.integrators.size() - i);
    limits.stop = [&, last = begin + patience * limits.seconds] {
      return watch.stop() || clock.spent() > std::min(last, end);
    };
    StepLimit& limit = guide.limits.emplace_back(find_step_limit(integrator, limits));
    if (limits.backends.empty()) limit.ending = given_up;
    for (const LateProgram& program : limit.late) {
      clock.forgive(program.ending);
      std::erase(limits.backends, program.backend);
      given_up = program.ending;
    }
  }
}

/// Measures the longest steps with which the two cheapest methods should keep the error. Their errors refine
/// the curves, which may change which methods are the cheapest.
void measure_longest_steps(SceneGuide& guide, std::span<WorkCurve> curves, const GuideWatch& watch,
                           GuideClock& clock, double end) {
  constexpr int most = 10;
  for (int taken = 0; taken < most; ++taken) {
    const std::vector<Ranked> ranked = by_cost(guide, guide.wish.error);
    if (ranked.empty()) return;
    const Ranked* second = second_of(ranked);
    const GuidedMethod* method = ranked.front().method;
    auto steps = steps_to_try(guide, *method);
    if (!steps && second != nullptr) {
      method = second->method;
      steps = steps_to_try(guide, *method);
    }
    if (!steps) return;
    WorkCurve& curve = curves[static_cast<std::size_t>(method - guide.methods.data())];
    if (watch.stop() || clock.spent() + curve.seconds_of(*steps) > end) return;
    watch.progress(fmt::format("longest step: {} {}", method->integrator->name, method->backend->name),
                   clock.fraction());
    if (!curve.measure(*steps)) return clock.forgive(method->ending);
  }
}

/// Measures the point that takes the least time first: so slow methods do not keep fast ones from reaching
/// the requested error, and every curve starts before one continues.
void measure_points(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch,
                    GuideClock& clock) {
  const double later = request.make_cloth ? share_of_sizes : 0;
  const double begin = clock.spent();
  const double end =
      clock.end_of_part(share_of_points, later + share_of_exact_steps + share_of_longest_steps);
  std::vector<ImplicitEnd> ends;
  std::vector<WorkCurve> curves;
  guide.methods.reserve(request.integrators.size() * request.backends.size());
  for (const StepLimit& limit : guide.limits)
    for (const BackendInfo* backend : request.backends) {
      GuidedMethod& method = guide.methods.emplace_back(GuidedMethod{limit.integrator, backend});
      curves.emplace_back(*request.system, guide.trusted, limit, method, request.execution,
                          request.wish.error);
    }
  const auto give_up = [&](const LateProgram& program) {
    for (WorkCurve& curve : curves)
      if (curve.method().backend == program.backend) curve.end(program.ending);
  };
  const auto forgive = [&](const GuidedMethod& method) {
    clock.forgive(method.ending);
    if (method.ending.late_s > 0) give_up({method.backend, method.ending});
  };
  for (const StepLimit& limit : guide.limits) std::ranges::for_each(limit.late, give_up);
  while (true) {
    const auto next = std::ranges::min_element(curves, {}, [](const WorkCurve& curve) {
      return curve.has_next() ? curve.next_seconds() : std::numeric_limits<double>::infinity();
    });
    if (next == curves.end() || !next->has_next()) break;
    GuidedMethod& method = next->method();
    if (watch.stop() || clock.spent() + next->next_seconds() > end) {
      next->end_without_time();
      continue;
    }
    if (!next->is_timed() && !is_implicit(*method.integrator)) {
      next->time_step();
      forgive(method);
      continue;
    }
    watch.progress(fmt::format("work and precision: {} {}", method.integrator->name, method.backend->name),
                   clock.fraction());
    auto state = next->next();
    forgive(method);
    if (state && is_implicit(*method.integrator) && !method.points.back().diverged)
      ends.push_back({&method, method.points.size() - 1, std::move(*state)});
  }
  guide.seconds_on_points = clock.spent() - begin;
  const double end_of_steps = clock.end_of_part(share_of_longest_steps, later + share_of_exact_steps);
  measure_longest_steps(guide, curves, watch, clock, end_of_steps);
  // A step takes far less time than a point, and shows what the method would have cost.
  for (WorkCurve& curve : curves) {
    const GuidedMethod& method = curve.method();
    if (!method.next || curve.is_timed() || is_implicit(*method.integrator)) continue;
    if (watch.stop() || clock.spent() > end_of_steps) break;
    curve.time_step();
    clock.forgive(method.ending);
    if (method.ending.late_s > 0) break;
  }
  watch.progress("errors of steps and solvers", clock.fraction());
  const double last = clock.end_of_part(share_of_exact_steps, later);
  tell_errors_apart(guide.methods, ends, *request.system, guide.trusted,
                    [&] { return watch.stop() || clock.spent() > last; });
  for (GuidedMethod& method : guide.methods) std::ranges::stable_sort(method.points, {}, &WorkPoint::steps);
}

void measure_cloths(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch,
                    const GuideClock& clock) {
  for (const GuidedMethod& method : guide.methods) {
    SizeCurve& curve = guide.sizes.emplace_back(
        SizeCurve{.integrator = method.integrator,
                  .backend = method.backend,
                  .dt_s = step_for_sizes(guide, method),
                  .keeps_error = cost_at_error(method, request.wish.error).has_value()});
    if (curve.dt_s == 0) curve.status = method.ending.status();
    if (curve.dt_s == 0 && curve.status.empty()) curve.status = "no step that was measured is stable";
  }
  const double end = clock.end_of_part(share_of_sizes, 0);
  measure_sizes(guide.sizes, request.make_cloth, request.execution, [&](const std::string& activity) {
    watch.progress("cloths of " + activity, clock.fraction());
    return !watch.stop() && clock.spent() < end;
  });
}

}  // namespace

bool SceneGuide::has_points() const {
  return std::ranges::any_of(methods, [](const GuidedMethod& method) { return !method.points.empty(); });
}

double rounded_up(double value) {
  const double places = 1 - std::floor(std::log10(value)), scale = std::pow(10, std::abs(places));
  return places > 0 ? std::ceil(value * scale - 1e-9) / scale : std::ceil(value / scale - 1e-9) * scale;
}

double needed_seconds(const SceneGuide& guide, std::span<const GuidedMethod* const> missed) {
  constexpr double steps_of_a_limit = 80;  // eight runs of ten steps, the minimum for a search
  const bool asks_reference =
      !guide.trusted.failure.empty() || std::ranges::any_of(missed, [](const GuidedMethod* method) {
        return method->ending.lack != Lack::time;
      });
  double needed = 2 * guide.seconds;
  if (asks_reference) needed = std::max(needed, guide.trusted.short_of_s / share_of_trust);
  // Each point of a curve takes twice as long as the one before.
  double longest = 0;
  for (const GuidedMethod* method : missed) {
    if (method->next) {
      const double step = expected_step(guide, *method->integrator).value_or(method->next->dt_s);
      const double halvings =
          std::clamp<double>(std::ceil(std::log2(method->next->dt_s / step) - 1e-9), 0, method->next->later);
      longest = std::max(longest, method->next->seconds * std::exp2(halvings));
    }
    const StepLimit* limit = limit_of(guide, method->integrator);
    if (limit != nullptr && limit->lack() == Lack::time)
      needed = std::max(needed, steps_of_a_limit * limit->step_seconds *
                                    static_cast<double>(guide.limits.size()) / share_of_limits);
  }
  double points = guide.seconds_on_points;
  for (const GuidedMethod& method : guide.methods) {
    if (!method.next) continue;
    int left = method.next->later + 1;
    for (double seconds = method.next->seconds; left-- > 0 && seconds <= longest; seconds *= 2)
      points += seconds;
  }
  return rounded_up(std::max(needed, points / share_of_points));
}

SceneGuide guide_scene(const GuideRequest& request, const GuideWatch& watch) {
  GuideClock clock(request.seconds);
  SceneGuide guide;
  guide.scene = request.execution.scene;
  guide.seconds = request.seconds;
  guide.nodes = request.system->nodes();
  guide.springs = request.system->springs.size();
  guide.wish = request.wish;
  watch.progress("spectrum of the start", 0);
  guide.at_start = guide.on_the_way = spectrum_at(*request.system, request.system->start);
  watch.progress("trusted trajectory", clock.fraction());
  find_trusted_state(guide, request, watch);
  const bool has_reference = guide.trusted.failure.empty();
  if (has_reference) {
    watch.progress("spectrum on the way", clock.fraction());
    guide.on_the_way = spectrum_at(*request.system, guide.trusted.state);
  }
  if (has_reference || clock.spent() <= request.seconds) find_limits(guide, request, watch, clock);
  if (has_reference) measure_points(guide, request, watch, clock);
  guide.stopped = watch.stop();
  mark_pareto_front(guide.methods);
  guide.recommendation = recommend(guide);
  if (has_reference && request.make_cloth) measure_cloths(guide, request, watch, clock);
  return guide;
}

}  // namespace mssim
