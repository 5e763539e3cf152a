#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "model/system.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The TABLE of scene kinds, in the order of SceneSpec::content's alternatives. A new kind is a row beside
/// what it describes, and an alternative.
std::span<const SceneKind* const> scene_kinds();

/// The row of the scene's kind.
const SceneKind& kind_of(const SceneSpec& spec);

/// Nodes and springs as the scene's file states them, which costs nothing; none where it does not.
std::optional<SceneCounts> stated_counts(const SceneSpec& spec);

/// What the scene is built from. Throws SceneError, and MissingProgram where bodies cannot be meshed.
SceneParts read_parts(const SceneSpec& spec);

/// Nodes and springs that the scene has. Reads its parts for that, and throws like read_parts.
SceneCounts counts_of(const SceneSpec& spec);

/// Counts what the scene's System has.
SceneCounts counts_of(const SceneSpec& spec, const System& system);

/// Throws SceneError when any run of the scene, which has these counts, needs more memory than there is
/// (memory_needed), naming both amounts.
void require_memory(const SceneSpec& spec, const SceneCounts& counts);

/// Throws SceneError when `needed` bytes for a use of the scene are more than the available memory, naming
/// both and the remedy.
void require_memory(const SceneSpec& spec, const SceneCounts& counts, std::uint64_t needed,
                    std::string_view remedy);

/// The scene of these parts. Throws like SceneParts::build, and before it like require_memory.
BuiltScene build_scene(const SceneSpec& spec, const SceneParts& parts);

/// The scene, its parts read for it alone. Throws like both.
BuiltScene build_scene(const SceneSpec& spec);

/// Its System alone.
System build_system(const SceneSpec& spec);

}  // namespace mssim
