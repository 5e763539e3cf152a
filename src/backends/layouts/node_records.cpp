#include "backends/layouts/node_records.h"

#include <algorithm>
#include <array>

namespace mssim {

void write_records(const State& state, std::span<const std::uint32_t> slot, float* records) {
  for (std::size_t node = 0; node < slot.size(); ++node) {
    const Vec3<float> x = vec3_cast<float>(state.position[node]), v = vec3_cast<float>(state.velocity[node]);
    const std::array<float, record_floats> record{x.x, x.y, x.z, 0, v.x, v.y, v.z, 0};
    std::copy(record.begin(), record.end(), records + std::size_t{slot[node]} * record_floats);
  }
}

State read_records(const float* records, std::span<const std::uint32_t> slot) {
  State state;
  for (const std::uint32_t number : slot) {
    const float* record = records + std::size_t{number} * record_floats;
    state.position.push_back({record[0], record[1], record[2]});
    state.velocity.push_back({record[4], record[5], record[6]});
  }
  return state;
}

}  // namespace mssim
