#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "guide/ranking.h"
#include "integrators/all_integrators.h"
#include "text/text.h"

namespace mssim {
namespace {

double cost_of(const WorkPoint& point) { return point.seconds_a_second(); }
double error_of(const WorkPoint& point) { return *point.position_error; }

/// Whether the point is stable but its error is too small to be told apart from the reference's.
bool is_beyond_trust(const WorkPoint& point) {
  return point.beyond_trust && point.within_limit && !point.diverged;
}

/// With two digits, or as many more as show on which side of `limit` the number is.
std::string digits_beside(double value, double limit) {
  for (int digits = 2; value != limit && digits < 17; ++digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    const double shown = number_in<double>(text).value_or(limit);
    if (value < limit ? shown < limit : shown > limit) return text;
  }
  return decimal(value);
}

/// Whether the method has such a point.
bool has_beyond_trust(const GuidedMethod& method) {
  return std::ranges::any_of(method.points, is_beyond_trust);
}

std::string named(const GuidedMethod& method) {
  return fmt::format("{} on {}", method.integrator->name, method.backend->name);
}

/// The points of the method that count, from the longest step to the shortest.
std::vector<const WorkPoint*> counting(const GuidedMethod& method) {
  std::vector<const WorkPoint*> curve;
  for (const WorkPoint& point : method.points)
    if (point.counts()) curve.push_back(&point);
  std::ranges::stable_sort(curve, std::ranges::greater(), &WorkPoint::dt_s);
  return curve;
}

std::string frames_sentence(const WorkPoint& point, const Wish& wish) {
  const double frame_s = steps_a_frame(point.dt_s, wish.frames_per_second) * point.seconds_a_step;
  return fmt::format("{} for {} frames per second",
                     frame_s * wish.frames_per_second <= 1 ? "fast enough" : "too slow",
                     decimal(wish.frames_per_second));
}

std::string what_to_take(const SceneGuide& guide, const Ranked& winner, const WorkPoint& point) {
  const double rate = guide.wish.frames_per_second;
  const auto steps = steps_to_try(guide, *winner.method);
  const StepLimit* limit = limit_of(guide, winner.method->integrator);
  const bool is_limited = !steps && winner.cost.at_longest_step && limit != nullptr &&
                          limit->measured.unstable_s > 0 && limit->measured.finished &&
                          guide.trusted.horizon_s > limit->measured.stable_s;  // else that limits it
  std::string text =
      fmt::format("Take {} with a step of {} s{}, which is {} per frame at {} frames per second.",
                  named(*winner.method), two_digits(point.dt_s),
                  is_limited ? fmt::format(", {} of the longest that is stable",
                                           two_digits(point.dt_s / limit->measured.stable_s))
                             : "",
                  pluralize(steps_a_frame(point.dt_s, rate), "step"), decimal(rate));
  if (steps)
    text += fmt::format(" A step of about {} s should suffice, too, but was not measured.",
                        digits_beside(guide.trusted.horizon_s / *steps, point.dt_s));
  return text;
}

std::string what_is_nearest(const GuidedMethod& method, const WorkPoint& point, const Wish& wish) {
  return fmt::format(
      "No measured method keeps the error within {} of a mean rest length: the most accurate is {} with a "
      "step of {} s.",
      decimal(wish.error), named(method), two_digits(point.dt_s));
}

/// Why it is not known whether a method keeps the error. `nearest`: the most accurate point that counts.
std::string why_not_judged(const SceneGuide& guide, const WorkPoint* nearest) {
  const double shown = guide.trusted.least_error(), error = guide.wish.error;
  return fmt::format(
      "No method can be judged at an error of {}: errors below {} of a mean rest length cannot be told apart "
      "from the reference's own. Give --error {} or more.",
      decimal(error), two_digits(shown),
      two_digits(rounded_up(nearest == nullptr || error < shown ? shown : error_of(*nearest))));
}

std::string what_it_costs(const WorkPoint& point, const SceneGuide& guide) {
  return fmt::format(
      "A simulated second takes {} s, {}. After {} s of simulation, the largest error of a node is {} of a "
      "mean rest length, and that of the energy {} of the kinetic and elastic energy.",
      three_digits(cost_of(point)), frames_sentence(point, guide.wish), two_digits(guide.trusted.horizon_s),
      digits_beside(error_of(point), guide.wish.error), two_digits(std::abs(point.energy_error.value_or(0))));
}

/// A half-open range of errors, [from, to); without `to`, it has no end.
struct ErrorRange {
  double from = 0;
  std::optional<double> to;
};

/// Advantage in cost of `other` over `winner` at an error, as the logarithm of the ratio. If only one of them
/// keeps the error, it is infinite, and negative if that is `winner`; it is negative, too, if neither does.
double advantage_at(const GuidedMethod& winner, const GuidedMethod& other, double error) {
  const auto mine = cost_at_error(other, error), its = cost_at_error(winner, error);
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (!mine) return -endless;
  return its ? std::log(its->seconds_a_second / mine->seconds_a_second) : endless;
}

/// The errors at which `other` is cheaper than `winner`, in ascending order. Between the errors of their
/// points, the advantage is linear in the logarithm of the error.
std::vector<ErrorRange> ranges_to_win(const GuidedMethod& winner, const GuidedMethod& other) {
  std::vector<double> errors;
  for (const GuidedMethod* method : {&winner, &other})
    for (const WorkPoint* point : counting(*method)) errors.push_back(error_of(*point));
  std::ranges::sort(errors);
  // The advantage cannot change between equal errors.
  errors.erase(std::unique(errors.begin(), errors.end()), errors.end());
  std::vector<ErrorRange> ranges;
  bool cheaper = false;
  const auto turn_at = [&](double error) {
    cheaper = !cheaper;
    if (cheaper)
      ranges.push_back({error, std::nullopt});
    else
      ranges.back().to = error;
  };
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double here = advantage_at(winner, other, errors[i]);
    if ((here > 0) != cheaper) turn_at(errors[i]);
    if (i + 1 == errors.size()) break;
    const double below_next = advantage_at(winner, other, errors[i + 1] * (1 - 1e-9));
    if ((below_next > 0) != cheaper && std::isfinite(here))
      turn_at(errors[i] * std::pow(errors[i + 1] / errors[i], here / (here - below_next)));
  }
  return ranges;
}

/// At most three ranges, none of which has the requested error in it, in words.
std::string in_words(std::span<const ErrorRange> ranges, double wished) {
  constexpr std::size_t most = 3;
  std::vector<std::string> texts;
  for (const ErrorRange& range : ranges.first(std::min(most, ranges.size()))) {
    const std::string from = digits_beside(range.from, wished);
    if (!range.to)
      texts.push_back(from + " or more");
    else if (const std::string to = digits_beside(*range.to, wished); to != from)
      texts.push_back(fmt::format("{} to below {}", from, to));
    else
      texts.push_back("about " + from);
  }
  if (ranges.size() > most) texts.emplace_back("some larger ones");
  return listed(texts);
}

std::string who_comes_second(const SceneGuide& guide, const Ranked& winner, const Ranked* second) {
  if (second == nullptr) return "No other measured method is accurate enough.";
  const WorkPoint* point = point_at_error(*second->method, guide.wish.error);
  const std::vector<ErrorRange> wins = ranges_to_win(*winner.method, *second->method);
  const double ratio = second->cost.seconds_a_second / winner.cost.seconds_a_second;
  return fmt::format(
      "The runner-up is {} with a step of {} s, which takes {} times as long at an error of {}{}",
      named(*second->method), two_digits(point->dt_s), three_digits(ratio), decimal(guide.wish.error),
      wins.empty() ? "; it is cheaper at no error."
                   : fmt::format("; it is cheaper at errors of {}.", in_words(wins, guide.wish.error)));
}

/// Whether more time would have given the method a cost at the requested error.
bool lacks_time(const SceneGuide& guide, const GuidedMethod& method) {
  if (cost_at_error(method, guide.wish.error)) return false;
  // Errors grow with the horizon, and smaller errors count with a better reference.
  const bool lacks_reference = guide.trusted.short_of_s > 0;
  if (method.ending.lack == Lack::time)
    return lacks_reference || guide.wish.error >= guide.trusted.least_error();
  return lacks_reference && std::ranges::any_of(method.points, &WorkPoint::beyond_trust);
}

/// Whether the curve of its integrator on another backend is complete but does not reach the requested error.
bool ends_short(const SceneGuide& guide, const GuidedMethod& method) {
  return std::ranges::any_of(guide.methods, [&](const GuidedMethod& other) {
    return other.integrator == method.integrator && other.ending.lack == Lack::nothing &&
           !lacks_time(guide, other) && !counting(other).empty() && !cost_at_error(other, guide.wish.error);
  });
}

/// Integrators by backends: "rk4 and verlet on serial and openmp; rk4 on opencl".
std::string names_of(std::span<const GuidedMethod* const> methods) {
  using Names = std::vector<std::string_view>;
  std::vector<std::pair<std::string_view, Names>> integrators;  // by backend
  for (const GuidedMethod* method : methods) {
    const std::string_view backend = method->backend->name;
    auto its = std::ranges::find(integrators, backend, &std::pair<std::string_view, Names>::first);
    if (its == integrators.end()) its = integrators.insert(its, {backend, {}});
    its->second.push_back(method->integrator->name);
  }
  std::vector<std::pair<Names, Names>> backends;  // by integrators
  for (const auto& [backend, names] : integrators) {
    auto its = std::ranges::find(backends, names, &std::pair<Names, Names>::first);
    if (its == backends.end()) its = backends.insert(its, {names, {}});
    its->second.push_back(backend);
  }
  std::vector<std::string> groups;
  for (const auto& [names, where] : backends)
    groups.push_back(fmt::format("{} on {}", listed(names), listed(where)));
  return join(groups, "; ");
}

std::string seconds_of(const SceneGuide& guide) { return decimal(std::round(10 * guide.seconds) / 10); }

/// Names the time that would suffice if there is `needed_s`.
std::string why_nothing(const SceneGuide& guide, std::optional<double> needed_s,
                        std::span<const GuidedMethod* const> missed) {
  std::string text = guide.stopped
                         ? "Nothing is recommended: the guide was stopped"
                         : fmt::format("Nothing is recommended: {} s is not enough", seconds_of(guide));
  if (!missed.empty())
    text += fmt::format(", and any of these methods could be the cheapest at an error of {}: {}",
                        decimal(guide.wish.error), names_of(missed));
  if (!needed_s) return text + '.';
  // A longer horizon takes more time for each point, and its errors are larger.
  const bool is_cut = guide.trusted.failure.empty() && guide.trusted.short_of_s > 0;
  return text + fmt::format(". About {} s for this scene {} (--time-budget).", decimal(*needed_s),
                            is_cut ? "may be needed" : "would suffice");
}

/// The integrator's time per step and, if it reaches the error, its cost there.
struct Compared {
  std::string_view integrator;
  double seconds_a_step = 0;
  std::optional<CostAtError> cost;
};

std::string integrators_of(std::span<const Compared> compared) {
  return listed(mapped<std::string>(compared, &Compared::integrator));
}

/// Compares the order of the integrators by time per step with that at the requested error; empty if fewer
/// than two were measured.
std::string order_on(const SceneGuide& guide, const BackendInfo& backend) {
  std::vector<Compared> all;
  for (const std::string_view name : paper_integrators)
    for (const GuidedMethod& method : guide.methods) {
      if (method.backend != &backend || method.integrator->name != name) continue;
      if (const auto curve = counting(method); !curve.empty())
        all.push_back({name, curve.back()->seconds_a_step, cost_at_error(method, guide.wish.error)});
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
      fmt::format("On {}, {} take {} ms per step", backend.name, integrators_of(all), listed(milliseconds));
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
  const auto stable = [&](std::string_view name) {
    const StepLimit* limit = limit_of(guide, find_integrator(name));
    return limit == nullptr ? 0 : limit->measured.stable_s;
  };
  const double euler = stable("explicit-euler"), semi = stable("semi-euler");
  if (euler <= 0 || semi <= 0) return {};
  std::optional<double> cheapest, its;
  for (const GuidedMethod& method : guide.methods)
    if (const auto cost = cost_at_error(method, guide.wish.error)) {
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

const StepLimit* limit_of(const SceneGuide& guide, const Integrator* integrator) {
  return found_in(guide.limits, integrator, &StepLimit::integrator);
}

std::optional<double> expected_step(const SceneGuide& guide, const Integrator& integrator) {
  const double error = guide.wish.error;
  std::optional<double> longest;
  const auto take = [&](double dt_s) { longest = std::max(longest.value_or(dt_s), dt_s); };
  for (const GuidedMethod& method : guide.methods) {
    if (method.integrator != &integrator) continue;
    if (const auto cost = cost_at_error(method, error))
      take(cost->dt_s);
    else if (const auto curve = counting(method); !curve.empty())
      take(curve.back()->dt_s * std::pow(error / error_of(*curve.back()), 1.0 / integrator.order));
  }
  const StepLimit* limit = limit_of(guide, &integrator);
  if (limit == nullptr || limit->measured.stable_s <= 0) return longest;
  return std::min(longest.value_or(limit->usable_s()), limit->usable_s());
}

double step_for_sizes(const SceneGuide& guide, const GuidedMethod& method) {
  if (const auto cost = cost_at_error(method, guide.wish.error)) return cost->dt_s;
  const WorkPoint* cheapest = nullptr;
  for (const WorkPoint& point : method.points)
    if (!point.diverged && point.within_limit && (cheapest == nullptr || cost_of(point) < cost_of(*cheapest)))
      cheapest = &point;
  return cheapest != nullptr ? cheapest->dt_s : 0;
}

std::vector<Ranked> by_cost(const SceneGuide& guide, double error) {
  std::vector<Ranked> ranked;
  for (const GuidedMethod& method : guide.methods)
    if (const auto cost = cost_at_error(method, error)) ranked.push_back({&method, *cost});
  std::ranges::stable_sort(ranked, {}, [](const Ranked& one) { return one.cost.seconds_a_second; });
  return ranked;
}

const Ranked* second_of(std::span<const Ranked> ranked) {
  const auto is_other = [&](const Ranked& one) {
    return one.method->integrator != ranked.front().method->integrator;
  };
  const auto other = std::ranges::find_if(ranked, is_other);
  if (other != ranked.end()) return &*other;
  return ranked.size() > 1 ? &ranked[1] : nullptr;
}

const WorkPoint* point_at_error(const GuidedMethod& method, double error) {
  const auto curve = counting(method);
  const auto found =
      std::ranges::find_if(curve, [&](const WorkPoint* point) { return error_of(*point) <= error; });
  return found != curve.end() ? *found : nullptr;
}

const WorkPoint* most_accurate(const GuidedMethod& method) {
  const WorkPoint* found = nullptr;
  for (const WorkPoint& point : method.points)
    if (point.counts() && (found == nullptr || error_of(point) < error_of(*found))) found = &point;
  return found;
}

std::optional<int> steps_to_try(const SceneGuide& guide, const GuidedMethod& method) {
  const auto cost = cost_at_error(method, guide.wish.error);
  if (!cost) return std::nullopt;
  double dt_s = cost->dt_s;
  const StepLimit* limit = limit_of(guide, method.integrator);
  if (cost->at_longest_step && limit != nullptr) dt_s = std::max(dt_s, limit->usable_s());
  const double horizon_s = guide.trusted.horizon_s;
  const int steps = std::max(1, static_cast<int>(std::ceil(horizon_s / dt_s - 1e-6)));
  const int known = point_at_error(method, guide.wish.error)->steps;
  if (steps * step_resolution > known) return std::nullopt;
  // A measured point between them does not count or is not accurate enough, unlike the curve.
  const bool was_tried = std::ranges::any_of(
      method.points, [&](const WorkPoint& point) { return point.steps >= steps && point.steps < known; });
  return was_tried ? std::nullopt : std::optional(steps);
}

std::vector<const GuidedMethod*> missed_methods(const SceneGuide& guide) {
  const std::vector<Ranked> ranked = by_cost(guide, guide.wish.error);
  const double cheapest =
      ranked.empty() ? std::numeric_limits<double>::infinity() : ranked.front().cost.seconds_a_second;
  std::vector<const GuidedMethod*> missed, implicit;
  for (const GuidedMethod& method : guide.methods) {
    if (!lacks_time(guide, method) || ends_short(guide, method)) continue;
    const auto step = expected_step(guide, *method.integrator);
    if (is_implicit(*method.integrator))
      implicit.push_back(&method);
    else if (!step || method.step_seconds == 0 || method.step_seconds / *step < cheapest)
      missed.push_back(&method);
  }
  const auto counts = [](const GuidedMethod& method) { return most_accurate(method) != nullptr; };
  return missed.empty() && std::ranges::none_of(guide.methods, counts) ? implicit : missed;
}

Recommendation recommend(const SceneGuide& guide) {
  Recommendation chosen;
  const auto place_of = [&](const GuidedMethod& method) {
    return static_cast<std::size_t>(&method - guide.methods.data());
  };
  const std::vector<const GuidedMethod*> missed = missed_methods(guide);
  const bool without_reference = !guide.trusted.failure.empty() && guide.trusted.short_of_s > 0;
  if (!missed.empty() || without_reference) {
    // The lack of time of a stopped guide does not show what budget it needs.
    if (!guide.stopped) chosen.needed_s = needed_seconds(guide, missed);
    chosen.sentences = {why_nothing(guide, chosen.needed_s, missed)};
    return chosen;
  }
  if (!guide.trusted.failure.empty()) return chosen;
  const std::vector<Ranked> ranked = by_cost(guide, guide.wish.error);
  if (ranked.empty()) {
    const WorkPoint* nearest = nullptr;
    for (const GuidedMethod& method : guide.methods)
      if (const WorkPoint* point = most_accurate(method);
          point != nullptr && (nearest == nullptr || error_of(*point) < error_of(*nearest))) {
        nearest = point;
        chosen.nearest = place_of(method);
      }
    const bool any_beyond = std::ranges::any_of(guide.methods, has_beyond_trust),
               is_too_small = guide.wish.error < guide.trusted.least_error();
    const auto is_late = [](const GuidedMethod& method) { return method.ending.lack == Lack::time; };
    const bool any_late = std::ranges::any_of(guide.methods, is_late);
    if ((any_beyond && nearest != nullptr) || (is_too_small && (any_beyond || any_late))) {
      chosen.nearest.reset();
      chosen.sentences = {why_not_judged(guide, nearest)};
    } else if (nearest != nullptr) {
      chosen.sentences = {what_is_nearest(guide.methods[*chosen.nearest], *nearest, guide.wish),
                          what_it_costs(*nearest, guide)};
    } else if (!guide.has_points()) {
      chosen.sentences = {"Nothing was measured: the remark of each method gives the reason."};
    } else {
      chosen.sentences = {any_beyond ? "No method can be recommended: the errors of all stable points cannot "
                                       "be told apart from the reference's own."
                                     : "No method can be recommended: no measured point is stable."};
    }
    return chosen;
  }
  const Ranked &winner = ranked.front(), *second = second_of(ranked);
  chosen.best = place_of(*winner.method);
  if (second != nullptr) chosen.runner_up = place_of(*second->method);
  const WorkPoint& best = *point_at_error(*winner.method, guide.wish.error);
  chosen.sentences = {what_to_take(guide, winner, best), what_it_costs(best, guide),
                      who_comes_second(guide, winner, second)};
  return chosen;
}

std::vector<std::string> what_was_measured(const SceneGuide& guide) {
  struct Group {
    std::string what;
    std::vector<const GuidedMethod*> methods = {};
  };
  const std::string error = decimal(guide.wish.error);
  Group late{"Not measured, for lack of time"};
  Group unavailable{"Not measured, because the backend cannot run them here"};
  Group not_timed{"Not measured, because their times mean nothing here"};
  Group failed{"Not measured down to an error of " + error + ", because the backend fails"};
  Group unstable{"Not measured, because no step that was tried is stable"};
  Group beyond{"Not compared at an error of " + error +
               ", because their smaller errors cannot be told apart from the reference's"};
  Group late_at_error{"Not measured down to an error of " + error + ", for lack of time"};
  Group others{"Not within an error of " + error + " with any step that was tried"};
  std::size_t measured = 0;
  for (const GuidedMethod& method : guide.methods) {
    const bool counts = most_accurate(method) != nullptr;
    if (counts) ++measured;
    if (cost_at_error(method, guide.wish.error)) continue;
    const Lack lack = method.ending.lack;
    Group& group = lack == Lack::failed                                     ? failed
                   : lack == Lack::not_timed                                ? not_timed
                   : lack == Lack::unsupported || lack == Lack::unavailable ? unavailable
                   : has_beyond_trust(method)                               ? beyond
                   : lack == Lack::time                                     ? counts ? late_at_error : late
                   : counts                                                 ? others
                                                                            : unstable;
    group.methods.push_back(&method);
  }
  std::vector<std::string> sentences{
      fmt::format("Measured: {} of {}.", measured, pluralize(guide.methods.size(), "method"))};
  for (const Group* group :
       {&late, &unavailable, &not_timed, &failed, &unstable, &beyond, &late_at_error, &others})
    if (!group->methods.empty())
      sentences.push_back(fmt::format("{}: {}.", group->what, names_of(group->methods)));
  return sentences;
}

std::optional<CostAtError> cost_at_error(const GuidedMethod& method, double error) {
  const WorkPoint* coarser = nullptr;
  for (const WorkPoint* point : counting(method)) {
    if (error_of(*point) > error) {
      coarser = point;
      continue;
    }
    if (coarser == nullptr) return CostAtError{cost_of(*point), point->dt_s, true};
    const double share =
        std::log(error_of(*coarser) / error) / std::log(error_of(*coarser) / error_of(*point));
    const auto between = [&](double from, double to) { return from * std::pow(to / from, share); };
    return CostAtError{between(cost_of(*coarser), cost_of(*point)), between(coarser->dt_s, point->dt_s),
                       false};
  }
  return std::nullopt;
}

std::array<double, 4> errors_around(const Wish& wish) {
  return {10 * wish.error, 3 * wish.error, wish.error, wish.error / 3};
}

std::vector<std::string> beside_the_paper(const SceneGuide& guide) {
  std::vector<std::string> sentences;
  for (const BackendInfo* backend : distinct<const BackendInfo*>(guide.methods, &GuidedMethod::backend))
    sentences.push_back(order_on(guide, *backend));
  sentences.push_back(explicit_euler_beside(guide));
  std::erase(sentences, "");
  return sentences;
}

}  // namespace mssim
