#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "model/system.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The kinds of the alternatives of SceneSpec::content, which are the TABLE of scene kinds, in their order.
std::span<const SceneKind* const> scene_kinds();

/// The row of the scene's kind.
const SceneKind& kind_of(const SceneSpec& spec);

/// Nodes and springs that the scene's file states, at no cost; nothing if it states none.
std::optional<SceneCounts> stated_counts(const SceneSpec& spec);

/// The parts that the scene is built from. Throws SceneError, and MissingProgram if bodies cannot be meshed.
SceneParts read_parts(const SceneSpec& spec);

/// Nodes and springs of the scene. Reads its parts, and throws like read_parts.
SceneCounts counts_of(const SceneSpec& spec);

/// Bytes that any run of a scene of this size needs at least: its System with the start state, the
/// double-precision reference that every run is compared with (up to four pairs of position and velocity),
/// and one state read back. The backend under test needs more.
std::uint64_t memory_needed(const SceneCounts& counts);

/// Throws SceneError, naming both amounts, if any run of the scene, which has these counts, needs more memory
/// than is available (memory_needed).
void require_memory(const SceneSpec& spec, const SceneCounts& counts);

/// Throws SceneError, naming both amounts and the remedy, if `needed` bytes for a use of the scene exceed the
/// available memory.
void require_memory(const SceneSpec& spec, const SceneCounts& counts, std::uint64_t needed,
                    std::string_view remedy);

/// Builds the scene from these parts. Throws like SceneParts::build, and first like require_memory.
BuiltScene build_scene(const SceneSpec& spec, const SceneParts& parts);

/// Reads the parts and builds the scene from them. Throws like both functions.
BuiltScene build_scene(const SceneSpec& spec);

/// Builds only the scene's System.
System build_system(const SceneSpec& spec);

}  // namespace mssim
