#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "model/system.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// A row of the TABLE of scene kinds.
struct SceneKind {
  std::string_view name;         ///< value of the file's `kind`, and the key of the section that describes it
  std::string_view description;  ///< of that section, in the schema
  /// Names the section's fields, with their targets in spec.content, which it sets to its alternative.
  void (*visit_fields)(FieldVisitor& fields, SceneSpec& spec);
  /// Checks what one field alone cannot show. Throws SceneError.
  void (*check)(const SceneSpec& spec);
  /// How often a spring is counted in Hong et al.'s tables, by inference from their numbers; none for a kind
  /// that they do not have.
  std::optional<std::uint64_t> published_per_spring;
  /// What the file says about nodes and unique springs, none where it says nothing.
  std::optional<SceneCounts> (*stated)(const SceneSpec& spec);
  /// Reads the files that it names. Throws SceneError and MissingProgram.
  SceneParts (*read)(const SceneSpec& spec);
};

/// The TABLE of scene kinds, in the order of SceneSpec::content's alternatives. A new kind is one row in
/// scene_kinds.cpp and one alternative.
std::span<const SceneKind> scene_kinds();

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

/// Throws SceneError when a use of the scene that needs `needed` bytes does not fit into memory.
void require_memory(const SceneSpec& spec, const SceneCounts& counts, std::uint64_t needed,
                    std::string_view remedy);

/// The scene of these parts. Throws like SceneParts::build.
BuiltScene build_scene(const SceneSpec& spec, const SceneParts& parts);

/// The scene, its parts read for it alone. Throws like both.
BuiltScene build_scene(const SceneSpec& spec);

/// Its System alone.
System build_system(const SceneSpec& spec);

}  // namespace mssim
