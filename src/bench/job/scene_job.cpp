#include "bench/job/scene_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace mssim {

double clock_resolution_s() {
  using Clock = std::chrono::steady_clock;
  Clock::duration smallest = Clock::duration::max();
  for (int i = 0; i < 1000; ++i) {
    const auto before = Clock::now();
    auto after = Clock::now();
    while (after == before) after = Clock::now();
    smallest = std::min(smallest, after - before);
  }
  return std::chrono::duration<double>(smallest).count();
}

int sample_steps(double step_seconds, double sample_seconds, double clock_resolution_seconds, int most) {
  const double seconds = std::max(step_seconds, 1e-12);
  const double enough_for_clock = std::ceil(least_clock_steps * clock_resolution_seconds / seconds);
  const double limit = std::max<double>(most, enough_for_clock);
  return static_cast<int>(std::clamp(sample_seconds / seconds, 1.0, std::min(limit, 1e9)));
}

bool is_warm(std::span<const double> trial_seconds) {
  if (trial_seconds.size() < 3) return false;
  constexpr double faster = 0.98;
  const auto last_two = trial_seconds.last(2);
  const double fastest = *std::min_element(trial_seconds.begin(), trial_seconds.end() - 2);
  return *std::min_element(last_two.begin(), last_two.end()) >= faster * fastest;
}

}  // namespace mssim
