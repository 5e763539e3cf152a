#include "fitting/dress.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace mssim {
namespace {

/// Distance that a share of the nodes has moved less than, m.
double moved(const State& before, const State& after, double share) {
  std::vector<double> distances;
  distances.reserve(after.position.size());
  for (std::size_t i = 0; i < after.position.size(); ++i)
    distances.push_back(length(after.position[i] - before.position[i]));
  const auto quantile =
      distances.begin() + std::min(static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size())),
                                   std::ssize(distances) - 1);
  std::nth_element(distances.begin(), quantile, distances.end());
  return *quantile;
}

}  // namespace

DressingResult dress(DressingBackend& backend, const System& system, double dt_s, const SettlingRule& rule,
                     const OnWindow& on_window) {
  const int window = std::max(1, static_cast<int>(std::lround(rule.window_s / dt_s)));
  const auto longest = static_cast<std::int64_t>(std::llround(rule.longest_s / dt_s));
  backend.set_state(system.start);
  DressingResult result;
  result.state = system.start;
  while (result.iterations < longest) {
    const bool was_draping = backend.progress().draping;
    backend.step(window);
    result.iterations += window;
    State state = backend.state();
    if (backend.progress().draping) result.seamed_at = backend.progress().seamed_at;
    // A window that began with open seams says nothing about how a sewn garment rests.
    result.settled = was_draping && moved(result.state, state, rule.share) < rule.distance;
    result.state = std::move(state);
    if (!on_window(result.state, result.iterations) || result.settled) break;
  }
  result.simulated_s = static_cast<double>(result.iterations) * dt_s;
  return result;
}

}  // namespace mssim
