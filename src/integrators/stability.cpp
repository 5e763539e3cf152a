#include "integrators/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "integrators/all_integrators.h"
#include "integrators/coefficients.h"

namespace mssim {
namespace {

/// A number as a linear function of the state at the start of a step: of_x * x + of_v * v. A step of such
/// numbers gives the step's matrix.
struct Linear {
  double of_x = 0, of_v = 0;

  friend Linear operator+(const Linear& a, const Linear& b) { return {a.of_x + b.of_x, a.of_v + b.of_v}; }
  friend Linear operator*(double s, const Linear& a) { return {s * a.of_x, s * a.of_v}; }
  friend Linear mul_add(double s, const Linear& a, const Linear& b) { return s * a + b; }
};

#define MSSIM_INLINE inline
#define MSSIM_INLINE_LAMBDA
#include "integrators/stage_update-inl.h"
#undef MSSIM_INLINE
#undef MSSIM_INLINE_LAMBDA

/// Largest modulus of the eigenvalues of the 2 x 2 matrix with these rows.
double spectral_radius(const Linear& first, const Linear& second) {
  const double half_trace = (first.of_x + second.of_v) / 2;
  const double determinant = first.of_x * second.of_v - first.of_v * second.of_x;
  const double discriminant = half_trace * half_trace - determinant;
  return discriminant < 0 ? std::sqrt(determinant) : std::abs(half_trace) + std::sqrt(discriminant);
}

/// Damping of a mode of that stiffness that stretches the first parts as far as they reach, then the next
/// ones.
double damping_in_order(const ModeBound& bound, double stiffness, const std::vector<ModeBound::Part>& parts) {
  double damping = bound.viscous_damping;
  for (const ModeBound::Part& part : parts) {
    const double taken = std::min(stiffness, part.stiffness);
    if (taken > 0) damping += part.damping * taken / part.stiffness;
    stiffness -= taken;
  }
  return std::min(damping, bound.damping);
}

bool is_stable(const Integrator& integrator, double dt_s, const ModeBound& bound) {
  return largest_amplification(integrator, dt_s, bound) <= 1 + tolerated_growth;
}

}  // namespace

double amplification(const Integrator& integrator, double dt_s, double stiffness, double damping) {
  const Coefficients<double> coefficients = coefficients_of<double>(integrator, dt_s);
  std::array<Linear, memory_slots> memory{};
  memory[index(Slot::x)] = {1, 0};
  memory[index(Slot::v)] = {0, 1};
  with_integrator(integrator, [&](auto method) {
    for_each_stage<method>([&](auto stage) {
      constexpr Pair gather = integrators[method].stages[stage].gather;
      const Linear x = memory[index(position_slot(gather))], v = memory[index(velocity_slot(gather))];
      const Linear a = -stiffness * x + -damping * v;
      update_stage<method, stage>(
          coefficients, x, v, a, [&](auto slot) { return memory[index(decltype(slot)::value)]; },
          [&](auto slot, const Linear& value) { memory[index(decltype(slot)::value)] = value; },
          [](const Linear&, const Linear&) {});
    });
  });
  return spectral_radius(memory[index(Slot::x_next)], memory[index(Slot::v_next)]);
}

double largest_amplification(const Integrator& integrator, double dt_s, const ModeBound& bound) {
  double largest = 0;
  const auto add = [&](double stiffness, double damping) {
    const double factor = amplification(integrator, dt_s, stiffness, damping);
    largest = std::isnan(factor) ? std::numeric_limits<double>::infinity() : std::max(largest, factor);
  };
  std::vector<ModeBound::Part> parts = bound.parts;
  std::ranges::sort(parts, [](const ModeBound::Part& a, const ModeBound::Part& b) {
    return a.damping * b.stiffness < b.damping * a.stiffness;
  });
  const std::vector<ModeBound::Part> from_the_last(parts.rbegin(), parts.rend());
  double dampers = 0;  // which do not resist
  for (const ModeBound::Part& part : parts) dampers += part.stiffness > 0 ? 0 : part.damping;
  const auto add_extremes = [&](double stiffness) {
    add(stiffness, damping_in_order(bound, stiffness, parts));
    add(stiffness, std::min(bound.damping, damping_in_order(bound, stiffness, from_the_last) + dampers));
  };
  // From the stiffest mode downwards, each a fifth softer; the last, a millionth as stiff, is nearly in free
  // flight.
  constexpr int modes = 63;
  double fraction = 1;
  for (int mode = 0; mode < modes; ++mode, fraction *= 0.8) {
    add(fraction * bound.stiffness,
        bound.viscous_damping + fraction * (bound.damping - bound.viscous_damping));
    if (!parts.empty()) add_extremes(fraction * bound.stiffness);
  }
  // The stiffest modes that stretch none of the springs that damp more.
  double reach = 0;
  for (const ModeBound::Part& part : parts) add_extremes(std::min(reach += part.stiffness, bound.stiffness));
  return largest;
}

double largest_stable_dt(const Integrator& integrator, const ModeBound& bound) {
  const double fastest_rate = std::max(std::sqrt(bound.stiffness), bound.damping);
  if (is_implicit(integrator) || !(fastest_rate > 0)) return std::numeric_limits<double>::infinity();
  // The first unstable dt going up, so an island of stability beyond it is not mistaken for the limit. A
  // consistent method that damping stabilises is stable at the start of the search, and no explicit method is
  // stable at its end.
  constexpr double step = 1.02;
  double unstable = 1e-5 / fastest_rate;
  if (!is_stable(integrator, unstable, bound)) return 0;
  while (is_stable(integrator, unstable, bound)) unstable *= step;
  double stable = unstable / step;
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = (stable + unstable) / 2;
    (is_stable(integrator, middle, bound) ? stable : unstable) = middle;
  }
  return stable;
}

double auto_dt(const ModeBound& bound, const std::function<bool(const Integrator& integrator)>& steps) {
  constexpr double safety = 0.5;
  double limit = std::numeric_limits<double>::infinity();
  for (const Integrator& integrator : integrators)
    if (is_of_paper(integrator) && (!steps || steps(integrator)))
      limit = std::min(limit, largest_stable_dt(integrator, bound));
  if (std::isinf(limit))
    throw std::invalid_argument(
        "dt_s \"auto\" needs a system with springs or damping, which bound it: give a number");
  return std::min(safety * limit, longest_dt_s);
}

}  // namespace mssim
