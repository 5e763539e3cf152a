#include "backends/implicit/local_global/step_matrix.h"

#include <limits>

namespace mssim {

StepMatrix::StepMatrix(const System& system, double dt_s) {
  constexpr std::uint32_t no_row = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> row(system.nodes(), 0);
  for (const std::uint32_t pin : system.pins) row[pin] = no_row;
  for (std::uint32_t i = 0; i < row.size(); ++i) {
    if (row[i] == no_row) continue;
    row[i] = static_cast<std::uint32_t>(node.size());
    node.push_back(i);
    diagonal.push_back((1 + dt_s * system.viscous_damping) * system.node_mass[i]);
  }
  for (const Spring& spring : system.springs) {
    const SpringMaterial& material = system.materials[spring.kind];
    const double weight = dt_s * (dt_s * material.stiffness + material.damping);
    const std::uint32_t first = row[spring.first], second = row[spring.second];
    if (first != no_row) diagonal[first] += weight;
    if (second != no_row) diagonal[second] += weight;
    if (first != no_row && second != no_row) couplings.push_back({first, second, weight});
  }
}

}  // namespace mssim
