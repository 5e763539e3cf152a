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

/// Reads and parses a file, strictly: no comments, no duplicate keys (which the JSON library would let pass,
/// the last one winning), no number that overflows, at most `deepest_json_level` levels. Throws SceneError.
JsonDocument read_json(const std::filesystem::path& file);

/// A JSON pointer (RFC 6901) to `key` in the object at `pointer`.
std::string json_pointer(std::string_view pointer, std::string_view key);

/// `text` for an error message: on one line, valid UTF-8, cut to about `length` bytes.
std::string printable(std::string_view text, std::size_t length = 80);

/// A number for an error message, as short as it reads back.
std::string shown_number(double number);

}  // namespace mssim
