#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/history.h"

namespace mssim {

/// Version of the lines of a history file that this mssim writes, and the only one that it reads.
inline constexpr std::uint32_t history_version = 1;

/// A line of a history file, a JSON object, without its line feed. Texts are cut to the length that reads
/// back.
std::string history_line(const HistoryEntry& entry);

/// The JSON Schema of a line, committed as docs/schemas/history.schema.json.
std::string history_schema();

/// The entries of a text with a JSON object per line (JSON Lines); empty lines are ignored. `file` is the
/// source of the text. Throws SceneError and InputError, one sentence with file, line, place, value and
/// remedy, for a line that is damaged or has another version.
std::vector<HistoryEntry> parse_history(const std::filesystem::path& file, std::string_view text);

/// The entries of a file. Throws like parse_history(), and UsageError for a file that cannot be read or has
/// no entries.
std::vector<HistoryEntry> read_history(const std::filesystem::path& file);

/// Reads the file, if there is one, has `change` change its entries, and writes it. No other mssim changes it
/// meanwhile, so none loses an entry. Throws like read_history() and `change`, and WriteError; the file is
/// then as it was.
void change_history(const std::filesystem::path& file,
                    const std::function<void(std::vector<HistoryEntry>& history)>& change);

}  // namespace mssim
