#include "guide/guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The point of the least measure among those that count and that `takes` takes.
template <class Takes, class Measure>
std::optional<std::size_t> least(std::span<const WorkPoint> points, const Takes& takes,
                                 const Measure& measure) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].counts() && takes(points[i]) && (!found || measure(points[i]) < measure(points[*found])))
      found = i;
  return found;
}

double cost_of(const WorkPoint& point) { return point.seconds_a_second(); }
double error_of(const WorkPoint& point) { return *point.position_error; }

std::string named(const WorkPoint& point) {
  return fmt::format("{} on {}", point.integrator->name, point.backend);
}

/// Wall time of a frame, s.
double frame_seconds(const WorkPoint& point, double frames_per_second) {
  return steps_a_frame(point.dt_s, frames_per_second) * point.seconds_a_step;
}

std::string frames_sentence(const WorkPoint& point, const Wish& wish) {
  const double seconds = frame_seconds(point, wish.frames_per_second), rate = 1 / seconds;
  const std::string asked = decimal(wish.frames_per_second);
  return seconds * wish.frames_per_second <= 1
             ? fmt::format("and {} frames a second hold ({} would)", asked, three_digits(rate))
             : fmt::format("so that {} frames a second do not hold ({} would)", asked, three_digits(rate));
}

std::string what_to_take(std::span<const WorkPoint> points, const Recommendation& chosen, const Wish& wish) {
  if (points.empty()) return "Nothing was measured: the remark of each method says why.";
  if (!chosen.best) {
    if (!chosen.nearest)
      return "Nothing that was measured can be recommended: no point is both stable and far enough from the "
             "reference's error.";
    const WorkPoint& point = points[*chosen.nearest];
    return "Nothing that was measured keeps the error within " + two_digits(wish.error) +
           " of a mean rest length: the most accurate is " + named(point) + " with a step of " +
           two_digits(point.dt_s) + " s.";
  }
  const WorkPoint& point = points[*chosen.best];
  const int steps = steps_a_frame(point.dt_s, wish.frames_per_second);
  return fmt::format("Take {} with a step of {} s, which is {} a frame at {} frames a second.", named(point),
                     two_digits(point.dt_s), pluralize(steps, "step"), decimal(wish.frames_per_second));
}

std::string what_it_costs(const WorkPoint& point, const Wish& wish, double horizon_s) {
  return "A simulated second takes " + three_digits(cost_of(point)) + " s, " + frames_sentence(point, wish) +
         "; " + two_digits(horizon_s) + " s after the start no node is off by more than " +
         two_digits(error_of(point)) + " of a mean rest length, and the energy by " +
         two_digits(std::abs(point.energy_error.value_or(0))) + " of what is kinetic and elastic.";
}

/// Errors that a user can bear, from one on up to another, which is not one of them; or without an end.
struct ErrorRange {
  double from = 0;
  std::optional<double> to;
};

/// For which errors `other` is cheaper than `winner`, in order. What a method costs for an error is what its
/// cheapest point within it does.
std::vector<ErrorRange> ranges_to_win(std::span<const WorkPoint> points, const WorkPoint& winner,
                                      const WorkPoint& other) {
  const auto cheapest = [&](const WorkPoint& method, double error) {
    return least(
        points, [&](const WorkPoint& p) { return same_method(p, method) && error_of(p) <= error; }, cost_of);
  };
  const auto is_cheaper = [&](double error) {
    const auto mine = cheapest(other, error), its = cheapest(winner, error);
    return mine && (!its || cost_of(points[*mine]) < cost_of(points[*its]));
  };
  std::vector<double> errors;  // from one of these to the next nothing changes
  for (const WorkPoint& point : points)
    if (point.counts()) errors.push_back(error_of(point));
  std::ranges::sort(errors);
  std::vector<ErrorRange> ranges;
  bool cheaper = false;
  for (const double error : errors) {
    const bool was_cheaper = std::exchange(cheaper, is_cheaper(error));
    if (cheaper && !was_cheaper) ranges.push_back({error, std::nullopt});
    if (!cheaper && was_cheaper) ranges.back().to = error;
  }
  return ranges;
}

/// Three of them at most, in words.
std::string in_words(std::span<const ErrorRange> ranges) {
  constexpr std::size_t most = 3;
  std::vector<std::string> texts;
  for (const ErrorRange& range : ranges.first(std::min(most, ranges.size()))) {
    const std::string from = two_digits(range.from);
    if (!range.to)
      texts.push_back(from + " or more");
    else if (const std::string to = two_digits(*range.to); to != from)
      texts.push_back(fmt::format("{} to below {}", from, to));
    else
      texts.push_back("about " + from);
  }
  if (ranges.size() > most) texts.emplace_back("some larger ones");
  return listed(texts);
}

std::string who_comes_second(std::span<const WorkPoint> points, const Recommendation& chosen) {
  const WorkPoint& winner = points[chosen.best ? *chosen.best : *chosen.nearest];
  if (!chosen.runner_up) return "No other method that was measured is accurate enough.";
  const WorkPoint& second = points[*chosen.runner_up];
  const std::vector<ErrorRange> wins = ranges_to_win(points, winner, second);
  const double ratio = cost_of(second) / cost_of(winner);
  return fmt::format("The runner-up is {} with a step of {} s, which takes {} times as long{}", named(second),
                     two_digits(second.dt_s), three_digits(ratio),
                     wins.empty() ? "; it is cheaper at no error."
                                  : fmt::format("; it would win at errors of {}.", in_words(wins)));
}

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

void find_trusted_state(SceneGuide& guide, const GuideRequest& request, const GuideWatch& watch) {
  const double limit =
      step_theory(*find_integrator("rk4"), *request.system, guide.at_start, guide.at_start).at_start_s;
  // A third of the stability limit of rk4 by theory: well within its order.
  const double first_dt_s = std::isfinite(limit) && limit > 0 ? limit / 3 : request.longest_horizon_s / 100;
  guide.trusted = trusted_state(*request.system, {.longest_s = request.longest_horizon_s,
                                                  .first_dt_s = first_dt_s,
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
    watch.progress(fmt::format("work and precision: {} {}", method.integrator->name, method.backend->name),
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

constexpr std::array<std::string_view, 3> paper_integrators{"semi-euler", "midpoint", "rk4"};

/// The integrator's time of a step and, where it reaches the error, its cost there.
struct Compared {
  std::string_view integrator;
  double seconds_a_step = 0;
  std::optional<CostAtError> cost;
};

std::vector<const WorkPoint*> counting(std::span<const WorkPoint> points, const GuidedMethod& method) {
  std::vector<const WorkPoint*> curve;
  for (const WorkPoint& point : points)
    if (point.counts() && is_of(point, method)) curve.push_back(&point);
  return curve;
}

std::string integrators_of(std::span<const Compared> compared) {
  std::vector<std::string> names;
  for (const Compared& one : compared) names.emplace_back(one.integrator);
  return listed(names);
}

/// What becomes of the order of the integrators at the wished error; empty where fewer than two were
/// measured.
std::string order_on(const SceneGuide& guide, const BackendInfo& backend) {
  std::vector<Compared> all;
  for (const std::string_view name : paper_integrators) {
    const GuidedMethod method{find_integrator(name), &backend, {}};
    const auto curve = counting(guide.points, method);
    if (!curve.empty())
      all.push_back(
          {name, curve.back()->seconds_a_step, cost_at_error(guide.points, method, guide.wish.error)});
  }
  if (all.size() < 2) return {};
  std::ranges::stable_sort(all, {}, &Compared::seconds_a_step);
  std::vector<std::string> milliseconds, seconds;
  std::vector<Compared> reaching, others;
  for (const Compared& one : all) {
    milliseconds.push_back(three_digits(1000 * one.seconds_a_step));
    (one.cost ? reaching : others).push_back(one);
  }
  std::string text =
      fmt::format("On {} a step of {} takes {} ms", backend.name, integrators_of(all), listed(milliseconds));
  const std::string error = decimal(guide.wish.error);
  if (reaching.empty()) return fmt::format("{}; none of them reaches an error of {}.", text, error);
  for (const Compared& one : reaching) seconds.push_back(three_digits(one.cost->seconds_a_second));
  const auto cost = [](const Compared& one) { return one.cost->seconds_a_second; };
  const bool same = others.empty() && std::ranges::is_sorted(reaching, {}, cost);
  text += fmt::format("; at an error of {} a simulated second takes {} s with {}", error, listed(seconds),
                      others.empty() ? "them" : integrators_of(reaching));
  if (!others.empty()) text += fmt::format(", and {} did not reach it", integrators_of(others));
  std::ranges::stable_sort(reaching, {}, cost);
  return text + (same ? ": the order is the same."
                      : fmt::format(": {} is the cheapest.", reaching.front().integrator));
}

std::string explicit_euler_beside(const SceneGuide& guide) {
  const auto limit_of = [&](std::string_view name) {
    const auto limit = std::ranges::find(guide.limits, find_integrator(name), &StepLimit::integrator);
    return limit == guide.limits.end() ? 0 : limit->measured.stable_s;
  };
  const double euler = limit_of("explicit-euler"), semi = limit_of("semi-euler");
  if (euler <= 0 || semi <= 0) return {};
  std::optional<double> cheapest, its;
  for (const GuidedMethod& method : guide.methods)
    if (const auto cost = cost_at_error(guide.points, method, guide.wish.error)) {
      const double seconds = cost->seconds_a_second;
      cheapest = std::min(cheapest.value_or(seconds), seconds);
      if (method.integrator == find_integrator("explicit-euler"))
        its = std::min(its.value_or(seconds), seconds);
    }
  return "explicit-euler was stable with " + three_digits(euler / semi) + " of semi-euler's largest step" +
         (its ? fmt::format(", and takes {} times as long as the cheapest method at an error of {}.",
                            three_digits(*its / *cheapest), decimal(guide.wish.error))
              : fmt::format(", and did not reach an error of {}.", decimal(guide.wish.error)));
}

}  // namespace

Recommendation recommend(std::span<const WorkPoint> points, const Wish& wish, double horizon_s) {
  Recommendation chosen;
  const auto within = [&](const WorkPoint& point) { return error_of(point) <= wish.error; };
  chosen.best = least(points, within, cost_of);
  if (!chosen.best)
    chosen.nearest = least(
        points, [](const WorkPoint&) { return true; }, error_of);
  chosen.sentences.push_back(what_to_take(points, chosen, wish));
  if (!chosen.best && !chosen.nearest) return chosen;
  const WorkPoint& taken = points[chosen.best ? *chosen.best : *chosen.nearest];
  if (chosen.best) {
    chosen.runner_up = least(
        points, [&](const WorkPoint& p) { return within(p) && p.integrator != taken.integrator; }, cost_of);
    if (!chosen.runner_up)
      chosen.runner_up = least(
          points, [&](const WorkPoint& p) { return within(p) && p.backend != taken.backend; }, cost_of);
  } else {
    chosen.runner_up = least(
        points, [&](const WorkPoint& p) { return p.integrator != taken.integrator; }, error_of);
  }
  chosen.sentences.push_back(what_it_costs(taken, wish, horizon_s));
  chosen.sentences.push_back(who_comes_second(points, chosen));
  return chosen;
}

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

std::optional<CostAtError> cost_at_error(std::span<const WorkPoint> points, const GuidedMethod& method,
                                         double error) {
  std::optional<CostAtError> least;
  const auto take = [&](double seconds, bool at_longest_step) {
    if (!least || seconds < least->seconds_a_second) least = CostAtError{seconds, at_longest_step};
  };
  const WorkPoint* coarser = nullptr;
  for (const WorkPoint* point : counting(points, method)) {
    const double here = *point->position_error, cost = point->seconds_a_second();
    if (here <= error) {
      take(cost, coarser == nullptr);
      if (coarser != nullptr && *coarser->position_error > error) {
        const double share =
            std::log(*coarser->position_error / error) / std::log(*coarser->position_error / here);
        take(coarser->seconds_a_second() * std::pow(cost / coarser->seconds_a_second(), share), false);
      }
    }
    coarser = point;
  }
  return least;
}

std::array<double, 4> errors_around(const Wish& wish) {
  return {10 * wish.error, 3 * wish.error, wish.error, wish.error / 3};
}

std::vector<std::string> beside_the_paper(const SceneGuide& guide) {
  std::vector<std::string> sentences;
  std::vector<const BackendInfo*> backends;
  for (const GuidedMethod& method : guide.methods)
    if (std::ranges::find(backends, method.backend) == backends.end()) {
      backends.push_back(method.backend);
      sentences.push_back(order_on(guide, *method.backend));
    }
  sentences.push_back(explicit_euler_beside(guide));
  std::erase(sentences, "");
  return sentences;
}

}  // namespace mssim
