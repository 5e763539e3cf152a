#include "bench/verification/blow_up.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace mssim {
std::optional<std::size_t> first_bad_node(const State& state) {
  const auto is_single = [](const Vec3d& a) {
    constexpr double largest = std::numeric_limits<float>::max();
    return std::abs(a.x) <= largest && std::abs(a.y) <= largest && std::abs(a.z) <= largest;
  };
  for (std::size_t i = 0; i < state.position.size(); ++i)
    if (!is_single(state.position[i]) || !is_single(state.velocity[i])) return i;
  return std::nullopt;
}

std::optional<BlowUp> find_blow_up(Backend& backend, const State& from, int steps) {
  return find_blow_up(
      [&](int count) {
        backend.set_state(from);
        backend.step(count);
        return first_bad_node(backend.state());
      },
      steps);
}

std::optional<BlowUp> find_blow_up(const std::function<std::optional<std::size_t>(int steps)>& bad_node_after,
                                   int steps) {
  int good = 0, bad = steps;
  std::optional<std::size_t> node = bad_node_after(bad);
  if (!node) return std::nullopt;
  while (bad - good > 1) {
    const int middle = good + (bad - good) / 2;
    if (const auto found = bad_node_after(middle)) {
      bad = middle;
      node = found;
    } else {
      good = middle;
    }
  }
  return BlowUp{bad, *node};
}

std::string describe(const BlowUp& blow_up, double dt_s, std::int64_t steps_before) {
  const std::int64_t step = steps_before + blow_up.step;
  std::ostringstream text;
  text << "blew up at step " << step << " (t = " << static_cast<double>(step) * dt_s << " s): node "
       << blow_up.node << " is not finite in single precision; take a smaller dt_s or \"auto\"";
  return text.str();
}

}  // namespace mssim
