#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace mssim {

/// A scene file is refused beyond these sizes: no scene needs them, and a wrong file should not fill the
/// memory.
inline constexpr std::size_t largest_json_bytes = std::size_t{16} << 20;
inline constexpr std::size_t deepest_json_level = 32;

/// A JSON file: where it came from, what it says.
struct JsonDocument {
  std::filesystem::path file;
  std::string text;
  nlohmann::json value;
};

/// Parses a text, strictly: no comments, no duplicate keys (which the JSON library would let pass, the last
/// one winning), no number that overflows, at most `deepest_json_level` levels. `file` is where it came from.
/// Throws SceneError.
JsonDocument parse_json(const std::filesystem::path& file, std::string text);

/// The same, from a file of at most `largest_json_bytes`.
JsonDocument read_json(const std::filesystem::path& file);

/// A JSON pointer (RFC 6901) to `key` in the object at `pointer`.
std::string json_pointer(std::string_view pointer, std::string_view key);

/// A number for an error message, as short as it reads back.
std::string shown_number(double number);

}  // namespace mssim
