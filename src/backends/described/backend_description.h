#pragma once

#include <filesystem>
#include <string>

#include "backends/process/process_backend.h"

namespace mssim {

/// Maximum size of a description: a wrong file should not fill the memory.
inline constexpr std::size_t largest_description_bytes = std::size_t{64} << 10;

/// The program in the text of a description, NAME.json (docs/protocol.md). Also looks up whether it can
/// be run. Throws SceneError, one sentence with file, place, value and remedy, as for a scene file.
BackendProgram parse_description(const std::filesystem::path& file, const std::string& text);

/// Reads and checks a description. Throws SceneError.
BackendProgram read_description(const std::filesystem::path& file);

/// The JSON Schema of descriptions, committed as docs/schemas/backend.schema.json.
std::string description_schema();

}  // namespace mssim
