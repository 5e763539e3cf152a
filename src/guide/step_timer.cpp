#include "guide/step_timer.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "platform/machine.h"

namespace mssim {

StepTime time_steps(Backend& backend, const System& system, int steps, double enough_s) {
  constexpr std::size_t few = 5, many = 100;
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
  } while (seconds.size() < many && (sum < enough_s || (seconds.size() < few && sum < 10 * enough_s)));
  return {std::ranges::min(seconds) / steps, static_cast<int>(seconds.size())};
}

}  // namespace mssim
