#include "guide/recommendation.h"

#include <algorithm>
#include <cmath>

#include "text/counted.h"
#include "text/decimal.h"

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

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

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
  const std::string asked = short_number(wish.frames_per_second);
  return holds(point, wish.frames_per_second)
             ? "and " + asked + " frames a second hold (" + three_digits(rate) + " would)"
             : "so that " + asked + " frames a second do not hold (" + three_digits(rate) + " would)";
}

std::string what_to_take(std::span<const WorkPoint> points, const Recommendation& chosen, const Wish& wish) {
  if (!chosen.best) {
    if (!chosen.nearest) return "Nothing that was measured can be recommended: all points diverged.";
    const WorkPoint& point = points[*chosen.nearest];
    return "Nothing that was measured keeps the error within " + short_number(wish.error) +
           " of a mean rest length: the most accurate is " + named(point) + " with a step of " +
           short_number(point.dt_s) + " s.";
  }
  const WorkPoint& point = points[*chosen.best];
  const int steps = steps_a_frame(point.dt_s, wish.frames_per_second);
  return "Take " + named(point) + " with a step of " + short_number(point.dt_s) + " s, which is " +
         counted(static_cast<std::uint64_t>(steps), "step") + " a frame at " +
         short_number(wish.frames_per_second) + " frames a second.";
}

std::string what_it_costs(const WorkPoint& point, const Wish& wish, double horizon_s) {
  return "A simulated second takes " + three_digits(cost_of(point)) + " s, " + frames_sentence(point, wish) +
         "; " + short_number(horizon_s) + " s after the start no node is off by more than " +
         short_number(error_of(point)) + " of a mean rest length, and the energy by " +
         short_number(std::abs(point.energy_error.value_or(0))) + " of what is kinetic and elastic.";
}

/// At which errors `other` is cheaper than `winner`: in words, or empty where it is nowhere.
std::string where_it_wins(std::span<const WorkPoint> points, const WorkPoint& winner,
                          const WorkPoint& other) {
  const auto cheapest = [&](const WorkPoint& method, double error) {
    return least(
        points, [&](const WorkPoint& p) { return same_method(p, method) && error_of(p) <= error; }, cost_of);
  };
  std::optional<double> least_error, largest_error;
  for (const WorkPoint& at : points) {
    if (!at.counts()) continue;
    const auto mine = cheapest(other, error_of(at)), its = cheapest(winner, error_of(at));
    if (!mine || (its && cost_of(points[*its]) <= cost_of(points[*mine]))) continue;
    least_error = std::min(least_error.value_or(error_of(at)), error_of(at));
    largest_error = std::max(largest_error.value_or(error_of(at)), error_of(at));
  }
  if (!least_error) return {};
  if (*least_error == *largest_error) return "at an error of about " + short_number(*least_error);
  return "at errors of " + short_number(*least_error) + " to " + short_number(*largest_error);
}

std::string who_comes_second(std::span<const WorkPoint> points, const Recommendation& chosen) {
  const WorkPoint& winner = points[chosen.best ? *chosen.best : *chosen.nearest];
  if (!chosen.runner_up) return "No other method that was measured is accurate enough.";
  const WorkPoint& second = points[*chosen.runner_up];
  const std::string where = where_it_wins(points, winner, second);
  const double ratio = cost_of(second) / cost_of(winner);
  return "The runner-up is " + named(second) + " with a step of " + short_number(second.dt_s) +
         " s, which takes " + three_digits(ratio) + " times as long" +
         (where.empty() ? "; it is cheaper at no error that was measured." : "; it would win " + where + ".");
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
