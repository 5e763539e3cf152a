#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "bench/machine/provenance.h"
#include "text/error.h"

namespace mssim {

/// Thrown for a provenance.json that cannot be read or understood. what() is one sentence with the file, the
/// place in it (a JSON pointer such as /cpu/model), the value and the remedy. Commands end with exit code 2.
struct ProvenanceError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Thrown for a folder of a later format version, of which this mssim may misread any file.
struct LaterFormatError : ProvenanceError {
  using ProvenanceError::ProvenanceError;
};

/// Larger files are refused: a provenance has a few thousand bytes, and a wrong file must fill neither the
/// memory nor a message.
inline constexpr std::size_t largest_provenance_bytes = std::size_t{256} << 10;

/// The version of result folders: a program refuses a folder of a later one. It grows when a program that
/// does not know the change would misread a file (not for a new column or member). Folders without it are
/// older.
inline constexpr int folder_format_version = 1;

/// The text of provenance.json, indented, without a final newline. Numbers must be finite; unknown values are
/// absent or null.
std::string provenance_text(const Provenance& provenance);

/// Reads the output of provenance_text. Checks every value. Members that all versions of mssim have written
/// are required; unknown members are ignored. Throws ProvenanceError, and LaterFormatError for a later format
/// version.
Provenance read_provenance(const std::filesystem::path& file);

/// Reads a text; messages name `file`. Throws like read_provenance.
Provenance parse_provenance(const std::filesystem::path& file, std::string_view text);

}  // namespace mssim
