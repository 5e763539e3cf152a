#pragma once

#include <cstdint>
#include <string_view>

#include "scene/spec/scene_spec.h"

namespace mssim {

/// Bytes that any run of a scene needs at least: its System with the start state, and the double-precision
/// reference that every run is compared with (up to four pairs of position and velocity), and one state read
/// back. The backend under test comes on top.
std::uint64_t memory_needed(std::uint64_t nodes, std::uint64_t springs);

/// Throws SceneError when any run of a scene of this size needs more than the available memory, as below.
void require_memory(const SceneSpec& spec, std::string_view pointer, const SceneCounts& counts);

/// Throws SceneError when `needed` bytes for a scene of this size are more than the available memory, naming
/// both and the remedy. `pointer` is the JSON pointer to what sets the size.
void require_memory(const SceneSpec& spec, std::string_view pointer, const SceneCounts& counts,
                    std::uint64_t needed, std::string_view remedy);

}  // namespace mssim
