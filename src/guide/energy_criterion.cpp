#include "guide/energy_criterion.h"

#include <algorithm>

#include "bench/verification/blow_up.h"
#include "model/energy.h"

namespace mssim {

double energy_bound(const System& system, double span_s) {
  const Energy start = energy_of(system, system.start);
  double mass = 0;
  for (const double node : system.node_mass) mass += node;
  const double fall = 0.5 * mass * system.gravity * system.gravity * span_s * span_s;
  const double given = std::min(fall, std::max(0.0, start.gravitational));
  return start.total() + allowed_energy_growth * (start.kinetic + start.elastic + given);
}

bool stays_below(Backend& backend, const System& system, int steps, double bound_j) {
  constexpr int looks = 30;
  backend.set_state(system.start);
  for (int look = 0, done = 0; look < looks; ++look) {
    const int until = static_cast<int>(static_cast<long long>(steps) * (look + 1) / looks);
    if (until == done) continue;
    backend.step(until - done);
    done = until;
    const State state = backend.state();
    if (first_bad_node(state) || !(energy_of(system, state).total() <= bound_j)) return false;
  }
  return true;
}

}  // namespace mssim
