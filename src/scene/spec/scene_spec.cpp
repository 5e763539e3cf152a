#include "scene/spec/scene_spec.h"

#include <fmt/core.h>

#include "platform/machine.h"
#include "scene/fields/fields.h"

namespace mssim {

std::uint64_t memory_needed(std::uint64_t nodes, std::uint64_t springs) {
  constexpr std::uint64_t start = 1, reference_pairs = 4, read_back = 1;
  return nodes * (start + reference_pairs + read_back) * 2 * sizeof(Vec3d) + springs * sizeof(Spring);
}

void require_memory(const SceneSpec& spec, std::string_view pointer, const SceneCounts& counts) {
  require_memory(spec, pointer, counts, memory_needed(counts.nodes, counts.springs_unique),
                 "make the scene smaller");
}

void require_memory(const SceneSpec& spec, std::string_view pointer, const SceneCounts& counts,
                    std::uint64_t needed, std::string_view remedy) {
  if (const auto shortage = memory_shortage(needed))
    refuse(spec.file, pointer,
           fmt::format("has {} nodes and {} springs and {}: {}", counts.nodes, counts.springs_unique,
                       *shortage, remedy));
}

}  // namespace mssim
