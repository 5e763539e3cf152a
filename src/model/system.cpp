#include "model/system.h"

#include <algorithm>
#include <array>

namespace mssim {

double mean_rest_length(const System& system) {
  double sum = 0;
  for (const Spring& spring : system.springs) sum += spring.rest_length;
  return system.springs.empty() ? 0 : sum / static_cast<double>(system.springs.size());
}

void round_to_single(State& state) {
  // Through memory: g++ 12 vectorises a conversion to float and back to double into nothing at all (-O2, no
  // fast-math).
  const auto round = [](double& value) {
    const volatile float single = static_cast<float>(value);
    value = static_cast<double>(single);
  };
  for (std::vector<Vec3d>* vectors : {&state.position, &state.velocity})
    for (Vec3d& vector : *vectors) {
      round(vector.x);
      round(vector.y);
      round(vector.z);
    }
}

StiffnessBound stiffness_bound(const System& system) {
  struct Sum {
    double stiffness = 0, damping = 0;
  };
  std::vector<Sum> node(system.nodes());
  for (const Spring& spring : system.springs) {
    const SpringMaterial& material = system.materials[spring.kind];
    for (const std::uint32_t end : {spring.first, spring.second}) {
      node[end].stiffness += material.stiffness;
      node[end].damping += material.damping;
    }
  }
  StiffnessBound bound;
  for (const Sum& sum : node) {
    bound.stiffness = std::max(bound.stiffness, 2 * sum.stiffness / system.node_mass);
    bound.damping = std::max(bound.damping, 2 * sum.damping / system.node_mass);
  }
  bound.damping += system.viscous_damping;
  return bound;
}

}  // namespace mssim
