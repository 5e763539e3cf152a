#include "bench/windows/window_verification.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "bench/verification/blow_up.h"
#include "bench/verification/deviation.h"
#include "model/energy.h"
#include "text/text.h"

namespace mssim {

std::optional<std::size_t> first_bad_node(const WindowBackend& backend, const WindowedCloth& cloth) {
  for (const GridWindow& window : cloth.windows)
    if (const auto node = first_bad_node(backend.window(window)))
      return node_of_cloth(window, *node, cloth.grid);
  return std::nullopt;
}

std::optional<BlowUp> find_blow_up(WindowBackend& backend, const WindowedCloth& cloth, int steps) {
  return find_blow_up(
      [&](int count) {
        backend.restart();
        backend.step(count);
        return first_bad_node(backend, cloth);
      },
      steps);
}

Verification verify_windows(WindowBackend& backend, const WindowedCloth& cloth, const Integrator& integrator,
                            const WindowReferences& reference, double dt_s) {
  if (reference.failure) {
    Verification result;
    result.failure = reference.failure;
    return result;
  }
  backend.restart();
  backend.step(reference.steps);
  return compare_windows(backend, cloth, integrator, reference, reference.steps, dt_s);
}

Verification compare_windows(WindowBackend& backend, const WindowedCloth& cloth, const Integrator& integrator,
                             const WindowReferences& reference, int steps, double dt_s) {
  Verification result;
  const std::string after = " after " + pluralize(static_cast<std::uint64_t>(steps), "step");
  double energy_off = 0, in_motion = 0, worst = 0;  // worst: in tolerances
  std::ostringstream why;
  for (const WindowReference& one : reference.windows) {
    const State state = backend.window(one.window);
    if (first_bad_node(state)) {
      const auto blow_up = find_blow_up(backend, cloth, steps);
      result.failure = blow_up ? describe(*blow_up, dt_s) : std::string(finite_in_the_next);
      return result;
    }
    const State& right = one.after(steps);
    const Energy expected = energy_of(one.system, right);
    energy_off += energy_of(one.system, state).total() - expected.total();
    in_motion += energy_in_motion(one.system, right, expected);
    const double error = position_deviation(one.system, right, state);
    const double tolerance = position_tolerance(one.system, integrator, steps);
    result.position_error = std::max(result.position_error, error);
    if (error <= tolerance || error / tolerance <= worst) continue;
    worst = error / tolerance;
    why.str("");
    why << "position error " << error << " of a rest length exceeds " << tolerance << after
        << " in the window from row " << one.window.row << " and column " << one.window.column << " on";
  }
  result.energy_drift = energy_off / in_motion;
  if (why.str().empty() && !(std::abs(result.energy_drift) <= energy_tolerance))
    why << "energy in the windows is off by " << result.energy_drift << " of the energy in motion, more than "
        << energy_tolerance << ',' << after;
  if (!why.str().empty()) result.failure = why.str();
  return result;
}

std::string share_seen(const WindowedCloth& cloth) {
  std::ostringstream text;
  text.precision(2);
  text << "verified in " << pluralize(static_cast<std::uint64_t>(cloth.windows.size()), "window") << ", "
       << 100 * static_cast<double>(cloth.nodes_in_windows()) / static_cast<double>(cloth.nodes())
       << " % of the nodes";
  return text.str();
}

}  // namespace mssim
