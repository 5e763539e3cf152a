#include "model/spectrum.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "laws/host_laws.h"

namespace mssim {
namespace {

/// What a spring answers changes of its ends with, in a state.
struct LinearSpring {
  std::uint32_t first, second;
  Vec3d direction;
  double along, across;
};

/// The springs' part of K, or of C, at the state.
std::vector<LinearSpring> linear_springs(const System& system, const State& state, bool damping) {
  std::vector<LinearSpring> springs;
  springs.reserve(system.springs.size());
  for (const Spring& spring : system.springs) {
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const double inverse_length = 1 / length(d);
    const SpringMaterial& material = system.materials[spring.kind];
    const double rest = material.stiffness * static_cast<double>(spring.rest_length);
    springs.push_back({spring.first, spring.second, inverse_length * d,
                       damping ? material.damping : material.stiffness,
                       damping ? 0 : spring_across(inverse_length, material.stiffness, rest)});
  }
  return springs;
}

class PowerIteration {
 public:
  PowerIteration(const System& system, const std::vector<LinearSpring>& springs)
      : system_(system), springs_(springs), x_(system.nodes()), force_(system.nodes()) {
    std::mt19937 random(19580101);  // any fixed seed: the same vector each time
    std::uniform_real_distribution<double> component(-1, 1);
    for (Vec3d& x : x_) x = {component(random), component(random), component(random)};
    for (const std::uint32_t node : system.pins) x_[node] = {};
    scale();
  }

  /// One iteration: the Rayleigh quotient of the vector before it.
  double next() {
    for (Vec3d& force : force_) force = {};
    for (const LinearSpring& spring : springs_) {
      const Vec3d pull = spring_jacobian_times(spring.direction, spring.along, spring.across,
                                               x_[spring.second] - x_[spring.first]);
      force_[spring.first] -= pull;
      force_[spring.second] += pull;
    }
    for (const std::uint32_t node : system_.pins) force_[node] = {};
    double quotient = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      quotient += dot(x_[i], force_[i]);
      x_[i] = (1 / system_.node_mass[i]) * force_[i];
    }
    scale();
    return quotient;
  }

 private:
  void scale() {
    double sum = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) sum += system_.node_mass[i] * dot(x_[i], x_[i]);
    if (!(sum > 0)) return;
    const double factor = 1 / std::sqrt(sum);
    for (Vec3d& x : x_) x = factor * x;
  }

  const System& system_;
  const std::vector<LinearSpring>& springs_;
  std::vector<Vec3d> x_, force_;
};

double spectral_radius_of(const System& system, const std::vector<LinearSpring>& springs) {
  constexpr int stride = 100, most = 3000;
  PowerIteration iteration(system, springs);
  double before = 0, quotient = 0;
  for (int done = 0; done < most; done += stride) {
    for (int i = 0; i < stride; ++i) quotient = iteration.next();
    if (!(std::abs(quotient - before) > 1e-3 * std::abs(quotient))) break;
    before = quotient;
  }
  return quotient;
}

}  // namespace

Spectrum spectrum_at(const System& system, const State& state) {
  return {spectral_radius_of(system, linear_springs(system, state, false)),
          spectral_radius_of(system, linear_springs(system, state, true)) + system.viscous_damping};
}

}  // namespace mssim
