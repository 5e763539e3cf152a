#include "guide/scene_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "guide/exact_steps.h"
#include "guide/pareto_front.h"
#include "guide/step_limits.h"
#include "guide/step_theory.h"
#include "guide/work_precision.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"

namespace mssim {
namespace {

/// Shares of the wall time. A part that ends early leaves its time to the next, and one that takes longer
/// takes none of theirs: on a busy machine the whole then takes longer.
constexpr double share_of_trust = 0.2, share_of_limits = 0.2, until_limits = 0.45, share_of_points = 0.35,
                 share_of_sizes = 0.2, share_of_exact_steps = 0.1;

/// How much of a guide's time is over.
class GuideClock {
 public:
  explicit GuideClock(double seconds) : seconds_(seconds) {}
  double spent() const { return watch_.seconds() - forgiven_; }
  /// What was lost in waiting for programs is not taken from the others.
  void forgive(const std::vector<LateProgram>& programs) {
    for (const LateProgram& program : programs) forgiven_ += program.seconds;
  }
  double fraction() const { return std::min(1.0, spent() / seconds_); }
  /// Seconds after the guide's start at which a part ends that begins now: it leaves `later` to what follows.
  double end_of_part(double share, double later) const {
    return std::max(spent() + share * seconds_, (1 - later) * seconds_);
  }

 private:
  double seconds_, forgiven_ = 0;
  Stopwatch watch_;
};

/// A third of the stability limit of rk4 by theory: well within its order.
double first_trusted_step(const SceneGuide& guide, const GuideRequest& request) {
  const double limit =
      step_theory(*find_integrator("rk4"), *request.system, guide.at_start, guide.at_start).at_start_s;
  return std::isfinite(limit) && limit > 0 ? limit / 3 : request.longest_horizon_s / 100;
}

void find_trusted_state(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch) {
  guide.trusted = trusted_state(*request.system, {.longest_s = request.longest_horizon_s,
                                                  .first_dt_s = first_trusted_step(guide, request),
                                                  .seconds = share_of_trust * request.seconds,
                                                  .stop = watch.stop});
}

void find_limits(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch, GuideClock& clock) {
  constexpr double patience = 1.5;  // shares that an integrator may take until it has a stable step
  LimitRequest limits{.system = request.system,
                      .backends = request.backends,
                      .execution = request.execution,
                      .at_start = guide.at_start,
                      .on_the_way = guide.on_the_way,
                      .seconds = 0,
                      .stop = {}};
  const double end = clock.end_of_part(share_of_limits, 1 - until_limits);
  std::string given_up;  // why there is no backend left
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
    if (limits.backends.empty()) limit.status = given_up;
    clock.forgive(limit.late);
    for (const LateProgram& program : limit.late) {
      std::erase(limits.backends, program.backend);
      given_up = program.status;
    }
  }
}

/// The point that takes the least time goes first: fast methods reach the wished error whatever the slow ones
/// take, and all curves have begun before one goes on.
void measure_points(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch,
                    GuideClock& clock) {
  const double later = request.make_cloth ? share_of_sizes : 0;
  const double end = clock.end_of_part(share_of_points, later + share_of_exact_steps);
  std::vector<ImplicitEnd> ends;
  std::vector<WorkCurve> curves;
  guide.methods.reserve(request.integrators.size() * request.backends.size());
  for (const StepLimit& limit : guide.limits)
    for (const BackendInfo* backend : request.backends) {
      GuidedMethod& method = guide.methods.emplace_back(GuidedMethod{limit.integrator, backend, {}});
      curves.emplace_back(*request.system, guide.trusted, limit, method, request.execution,
                          request.wish.error);
    }
  const auto give_up = [&](const std::vector<LateProgram>& programs) {
    for (const LateProgram& program : programs)
      for (std::size_t i = 0; i < curves.size(); ++i)
        if (guide.methods[i].backend == program.backend) curves[i].end(program.status);
  };
  for (const StepLimit& limit : guide.limits) give_up(limit.late);
  while (true) {
    const auto next = std::ranges::min_element(curves, {}, [](const WorkCurve& curve) {
      return curve.has_next() ? curve.next_seconds() : std::numeric_limits<double>::infinity();
    });
    if (next == curves.end() || !next->has_next()) break;
    GuidedMethod& method = guide.methods[static_cast<std::size_t>(next - curves.begin())];
    if (watch.stop() || clock.spent() + next->next_seconds() > end) {
      next->end("no time was left for smaller steps");
      continue;
    }
    watch.progress("work and precision: " + std::string(method.integrator->name) + ' ' +
                       std::string(method.backend->name),
                   clock.fraction());
    auto measured = next->next();
    clock.forgive(method.late);
    give_up(method.late);
    if (!measured) continue;
    if (is_implicit(*method.integrator) && !measured->point.diverged)
      ends.push_back({guide.points.size(), std::move(measured->state)});
    guide.points.push_back(std::move(measured->point));
  }
  watch.progress("errors of steps and solvers", clock.fraction());
  const double last = clock.end_of_part(share_of_exact_steps, later);
  tell_errors_apart(guide.points, ends, *request.system, guide.trusted,
                    [&] { return watch.stop() || clock.spent() > last; });
  const auto place = [&](const WorkPoint& point) {
    return std::ranges::find_if(guide.methods,
                                [&](const GuidedMethod& method) { return is_of(point, method); });
  };
  std::ranges::stable_sort(guide.points, {}, [&](const WorkPoint& point) { return place(point); });
}

/// The method's cheapest point that is accurate enough, else its cheapest stable one; null without any.
const WorkPoint* cheapest_point(const SceneGuide& guide, const GuidedMethod& method) {
  const auto rank = [&](const WorkPoint& point) {
    const bool accurate = point.counts() && *point.position_error <= guide.wish.error;
    return std::pair(!accurate, point.seconds_a_second());
  };
  const WorkPoint* cheapest = nullptr;
  for (const WorkPoint& point : guide.points)
    if (is_of(point, method) && !point.diverged && point.within_limit &&
        (cheapest == nullptr || rank(point) < rank(*cheapest)))
      cheapest = &point;
  return cheapest;
}

void measure_cloths(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch,
                    const GuideClock& clock) {
  for (const GuidedMethod& method : guide.methods) {
    SizeCurve curve{.integrator = method.integrator, .backend = method.backend, .samples = {}, .status = {}};
    if (const WorkPoint* point = cheapest_point(guide, method)) {
      curve.dt_s = point->dt_s;
      curve.keeps_error = point->counts() && *point->position_error <= request.wish.error;
    } else {
      curve.status = method.status.empty() ? "no step that was measured is stable" : method.status;
    }
    guide.sizes.push_back(curve);
  }
  const double end = clock.end_of_part(share_of_sizes, 0);
  measure_sizes(guide.sizes, request.make_cloth, request.execution,
                [&](const std::string& activity, double /*done*/) {
                  watch.progress("cloths of " + activity, clock.fraction());
                  return !watch.stop() && clock.spent() < end;
                });
}

}  // namespace

SceneGuide guide_scene(const GuideRequest& request, const GuideWatch& watch) {
  GuideClock clock(request.seconds);
  SceneGuide guide;
  guide.scene = request.scene;
  guide.nodes = request.system->nodes();
  guide.springs = request.system->springs.size();
  guide.wish = request.wish;
  watch.progress("spectrum of the start", 0);
  guide.at_start = guide.on_the_way = spectrum_at(*request.system, request.system->start);
  watch.progress("trusted trajectory", clock.fraction());
  find_trusted_state(guide, request, watch);
  if (guide.trusted.failure.empty()) {
    watch.progress("spectrum on the way", clock.fraction());
    guide.on_the_way = spectrum_at(*request.system, guide.trusted.state);
  } else if (clock.spent() > request.seconds) {
    return guide;
  }
  find_limits(guide, request, watch, clock);
  if (!guide.trusted.failure.empty()) return guide;
  measure_points(guide, request, watch, clock);
  mark_pareto_front(guide.points);
  guide.recommendation = recommend(guide.points, request.wish, guide.trusted.horizon_s);
  if (request.make_cloth) measure_cloths(guide, request, watch, clock);
  return guide;
}

}  // namespace mssim
