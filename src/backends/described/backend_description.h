#pragma once

#include <filesystem>
#include <string>

#include "backends/process/process_backend.h"

namespace mssim {

/// A description of a backend is refused beyond this size: a wrong file should not fill the memory.
inline constexpr std::size_t largest_description_bytes = std::size_t{64} << 10;

/// The program that the text of a description, NAME.json, stands for (docs/protocol.md). Whether it can
/// be run is looked up now. Throws SceneError, one sentence with file, place, value and remedy, as for the
/// text of a scene file.
BackendProgram parse_description(const std::filesystem::path& file, const std::string& text);

/// Reads and checks a description. Throws SceneError.
BackendProgram read_description(const std::filesystem::path& file);

}  // namespace mssim
