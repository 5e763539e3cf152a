#pragma once

#include <vector>

#include "geometry/vec3.h"

namespace mssim {

/// Fields of NodeRows and NodeSlices from and to arrays in the scene's node order.

/// Rounds to float.
template <class Nodes>
void write_field(const Nodes& nodes, const std::vector<Vec3d>& values, float* field) {
  const std::size_t step = nodes.component_step();
  for (std::size_t node = 0; node < values.size(); ++node) {
    float* const to = field + nodes.offset(node);
    to[0] = static_cast<float>(values[node].x);
    to[step] = static_cast<float>(values[node].y);
    to[2 * step] = static_cast<float>(values[node].z);
  }
}

template <class Nodes>
std::vector<Vec3d> read_field(const Nodes& nodes, const float* field) {
  std::vector<Vec3d> values;
  values.reserve(nodes.nodes);
  const std::size_t step = nodes.component_step();
  for (std::size_t node = 0; node < nodes.nodes; ++node) {
    const float* const from = field + nodes.offset(node);
    values.push_back(vec3_cast<double>(Vec3<float>{from[0], from[step], from[2 * step]}));
  }
  return values;
}

}  // namespace mssim
