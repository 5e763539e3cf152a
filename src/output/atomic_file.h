#pragma once

#include <filesystem>
#include <string_view>

namespace mssim {

/// Writes a file so that at every moment, even after a crash of the machine, either the whole old file or the
/// whole new one stands under its name: FILE.part beside it is written, synced and renamed, then the folder
/// is synced. Replaces regular files only. Throws WriteError, after removing FILE.part.
void write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// The name under which `file` is written until it is whole: FILE.part.
std::filesystem::path temporary_of(const std::filesystem::path& file);

/// Throws WriteError when `file` exists and is not a regular file, so that a rename would replace a folder or
/// a device. Long writers ask before they start.
void require_replaceable(const std::filesystem::path& file);

/// The second half of an atomic write, for writers that fill the temporary themselves: syncs
/// temporary_of(file), renames it to `file` and syncs the folder. Throws WriteError and then leaves the
/// temporary where it is.
void move_into_place(const std::filesystem::path& file);

}  // namespace mssim
