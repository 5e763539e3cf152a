#include "output/traces/node_strain.h"

#include <cstddef>
#include <cstdint>

namespace mssim {

std::vector<double> node_strain(const TraceContent& content, const std::vector<Vec3d>& positions) {
  std::vector<double> strain(content.nodes);
  std::vector<std::uint32_t> springs(content.nodes);
  for (std::size_t i = 0; i < content.rest_length.size(); ++i) {
    const auto& [first, second] = content.springs[i];
    const double rest = content.rest_length[i];
    if (rest <= 0) continue;
    const double stretched = length(positions[second] - positions[first]) / rest - 1;
    for (const std::uint32_t node : {first, second}) {
      strain[node] += stretched;
      ++springs[node];
    }
  }
  for (std::size_t node = 0; node < strain.size(); ++node)
    if (springs[node] > 0) strain[node] /= springs[node];
  return strain;
}

}  // namespace mssim
