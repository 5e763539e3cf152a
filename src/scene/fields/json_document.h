#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace mssim {

/// A scene file with more levels is refused.
inline constexpr std::size_t deepest_json_level = 32;

/// Parses a text, strictly: no comments, no duplicate keys (which the JSON library would let pass, the last
/// one winning), no number that overflows, at most `deepest_json_level` levels. `file` is where it came from.
/// Throws SceneError.
nlohmann::json parse_json(const std::filesystem::path& file, const std::string& text);

/// A JSON pointer (RFC 6901) to `key` in the object at `pointer`.
std::string json_pointer(std::string_view pointer, std::string_view key);

}  // namespace mssim
