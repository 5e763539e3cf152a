#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/spec/scene_spec.h"

namespace mssim {

/// Maximum size of a scene file: no scene needs it, and a wrong file should not fill the memory.
inline constexpr std::size_t largest_scene_bytes = std::size_t{16} << 20;

/// The JSON Schema of scene files, committed as scenes/scene.schema.json.
std::string scene_schema();

/// Parses and checks the text of a scene file, which need not exist but names the scene. Throws SceneError.
SceneSpec parse_scene(const std::filesystem::path& file, std::string text);

/// Reads and checks a scene file. Throws SceneError.
SceneSpec load_scene(const std::filesystem::path& file);

/// Is it a path (with a slash or ending in .json) rather than the name of a scene?
bool is_path_of_scene(std::string_view name_or_path);

/// Is there a scene of that name, or a file at that path?
bool is_scene(std::string_view name_or_path);

/// The scene of that name (NAME.json in the data folder's scenes/), or at that path. Throws SceneError; for
/// an unknown name it lists the known ones.
SceneSpec find_scene(std::string_view name_or_path);

/// The scenes in the data folder, by kind, the smallest (in stated nodes) first. Throws SceneError if one of
/// them cannot be read.
std::vector<SceneSpec> shipped_scenes();

}  // namespace mssim
