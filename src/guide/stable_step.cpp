#include "guide/stable_step.h"

#include <algorithm>
#include <cmath>

#include "guide/energy_criterion.h"

namespace mssim {

bool is_stable(Backend& backend, const System& system, double dt_s, const StepSearch& search) {
  const int steps = std::max(search.least_steps, static_cast<int>(std::ceil(search.span_s / dt_s)));
  return stays_below(backend, system, steps, energy_bound(system, steps * dt_s));
}

StableStep largest_stable_step(const System& system, const StepMaker& make, const StepSearch& search) {
  constexpr double first_stride = 1.5;
  StableStep found;
  found.span_s = search.span_s;
  const auto try_step = [&](double dt_s) {
    ++found.runs;
    const bool stable = is_stable(*make(dt_s), system, dt_s, search);
    (stable ? found.stable_s : found.unstable_s) = dt_s;
    return stable;
  };
  double dt_s = std::clamp(search.first_s, search.shortest_s, search.longest_s);
  const bool first_is_stable = try_step(dt_s);
  // Away from the first until both kinds are known.
  for (double stride = first_stride; found.stable_s == 0 || found.unstable_s == 0; stride *= first_stride) {
    const double next =
        std::clamp(first_is_stable ? dt_s * stride : dt_s / stride, search.shortest_s, search.longest_s);
    if (next == dt_s) return found;
    if (search.stop()) {
      found.finished = false;
      return found;
    }
    dt_s = next;
    try_step(dt_s);
  }
  while (found.unstable_s > step_resolution * found.stable_s) {
    if (search.stop() || search.hurry()) {
      found.finished = false;
      break;
    }
    try_step(std::sqrt(found.stable_s * found.unstable_s));
  }
  return found;
}

}  // namespace mssim
