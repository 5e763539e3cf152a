#include "guide/recommendation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

/// The cheapest, or where `more_accurate` the most accurate, point that counts and that `takes` takes.
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
  return std::string(point.integrator->name) + " on " + point.backend;
}

/// Wall time of a frame, s.
double frame_seconds(const WorkPoint& point, double frames_per_second) {
  return steps_a_frame(point.dt_s, frames_per_second) * point.seconds_a_step;
}

bool holds(const WorkPoint& point, double frames_per_second) {
  return frame_seconds(point, frames_per_second) * frames_per_second <= 1;
}

std::string frames_sentence(const WorkPoint& point, const Wish& wish) {
  const double rate = 1 / frame_seconds(point, wish.frames_per_second);
  const std::string asked = decimal(wish.frames_per_second);
  return holds(point, wish.frames_per_second)
             ? "and " + asked + " frames a second hold (" + three_digits(rate) + " would)"
             : "so that " + asked + " frames a second do not hold (" + three_digits(rate) + " would)";
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
  return "Take " + named(point) + " with a step of " + two_digits(point.dt_s) + " s, which is " +
         pluralize(static_cast<std::uint64_t>(steps), "step") + " a frame at " +
         decimal(wish.frames_per_second) + " frames a second.";
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
      texts.push_back(from + " to below " + to);
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
  return "The runner-up is " + named(second) + " with a step of " + two_digits(second.dt_s) +
         " s, which takes " + three_digits(ratio) + " times as long" +
         (wins.empty() ? "; it is cheaper at no error."
                       : "; it would win at errors of " + in_words(wins) + ".");
}

}  // namespace

int steps_a_frame(double dt_s, double frames_per_second) {
  // A step that fits but for its last digits fits.
  return std::max(1, static_cast<int>(std::ceil(1 / (frames_per_second * dt_s) - 1e-9)));
}

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
  chosen.holds_frames = holds(taken, wish.frames_per_second);
  chosen.sentences.push_back(what_it_costs(taken, wish, horizon_s));
  chosen.sentences.push_back(who_comes_second(points, chosen));
  return chosen;
}

}  // namespace mssim
