#include "guide/equal_error.h"

#include <algorithm>
#include <cmath>

#include "integrators/all_integrators.h"
#include "text/text.h"

namespace mssim {
namespace {

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
  std::string text = "On " + std::string(backend.name) + " a step of " + integrators_of(all) + " takes " +
                     listed(milliseconds) + " ms";
  const std::string error = decimal(guide.wish.error);
  if (reaching.empty()) return text + "; none of them reaches an error of " + error + ".";
  for (const Compared& one : reaching) seconds.push_back(three_digits(one.cost->seconds_a_second));
  const auto cost = [](const Compared& one) { return one.cost->seconds_a_second; };
  const bool same = others.empty() && std::ranges::is_sorted(reaching, {}, cost);
  text += "; at an error of " + error + " a simulated second takes " + listed(seconds) + " s with " +
          (others.empty() ? "them" : integrators_of(reaching));
  if (!others.empty()) text += ", and " + integrators_of(others) + " did not reach it";
  std::ranges::stable_sort(reaching, {}, cost);
  return text + (same ? ": the order is the same."
                      : ": " + std::string(reaching.front().integrator) + " is the cheapest.");
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
         (its ? ", and takes " + three_digits(*its / *cheapest) +
                    " times as long as the cheapest method at an error of " + decimal(guide.wish.error) + "."
              : ", and did not reach an error of " + decimal(guide.wish.error) + ".");
}

}  // namespace

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
