#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/history.h"

namespace mssim {

/// Version of the lines of a history file that this mssim writes, and the only one that it reads.
inline constexpr std::uint32_t history_version = 1;

/// A line of a history file, a JSON object, without its line feed. Texts are cut to what reads back.
std::string history_line(const HistoryEntry& entry);

/// The entries of a text with a JSON object per line (JSON Lines); empty lines are ignored. `file` is the
/// source of the text. Throws SceneError and InputError, one sentence with file, line, place, value and
/// remedy, for a line that is damaged or has another version.
std::vector<HistoryEntry> parse_history(const std::filesystem::path& file, std::string_view text);

/// The entries of a file. Throws like parse_history(), and UsageError for a file that cannot be read.
std::vector<HistoryEntry> read_history(const std::filesystem::path& file);

/// Writes the whole file. Throws WriteError.
void write_history(const std::filesystem::path& file, const std::vector<HistoryEntry>& history);

}  // namespace mssim
