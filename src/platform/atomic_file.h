#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "platform/descriptor.h"

namespace mssim {

/// The name under which `file` is written until it is whole: FILE.part.
std::filesystem::path temporary_of(const std::filesystem::path& file);

/// For the end of a WriteError's sentence: that FILE.part keeps so many of `what` ("frames"); empty for none.
std::string kept_in_part(const std::filesystem::path& file, std::string_view what, std::size_t count);

/// Where a file that the user names is written: itself, or what it leads to where it is a link, through
/// however many. Throws WriteError for what cannot be replaced, and for links in a circle.
std::filesystem::path target_of(const std::filesystem::path& file);

/// Throws WriteError when `file` exists and is neither a regular file nor a link, so that a rename would
/// replace a folder or a device, and when it lies in /dev (but for /dev/shm), /proc or /sys.
void require_replaceable(const std::filesystem::path& file);

/// A file that is filled as FILE.part, by one writer at a time, and gets its name when it is whole: at every
/// moment, even after a crash of the machine, either the whole old file or the whole new one stands there.
/// Links are not followed: one in the place of the file is replaced, so that what lies in a folder decides
/// over no file outside. Where the user names the file, target_of() follows them first.
class AtomicFile {
 public:
  /// Makes FILE.part this writer's, and empty. Throws WriteError where another writer has it, in this process
  /// or another one, like require_replaceable(), where FILE.part is a link or no regular file, and where it
  /// cannot be created.
  explicit AtomicFile(std::filesystem::path file);
  AtomicFile(AtomicFile&&) = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Removes FILE.part unless the writing has ended.
  ~AtomicFile() { remove(); }

  const std::filesystem::path& name() const { return name_; }

  /// Adds to the end of FILE.part. Throws WriteError; FILE.part then ends where it did before.
  void append(std::string_view text);
  /// Ends the writing: syncs FILE.part, renames it to FILE and syncs the folder. Throws WriteError and then
  /// leaves FILE.part as it is, still this writer's.
  void move_into_place();
  /// Ends the writing and leaves FILE.part to the user, for what it holds so far.
  void keep() { part_ = Descriptor(); }
  /// Ends the writing and removes FILE.part.
  void remove();
  /// Whether the writing has not ended.
  bool is_under_way() const { return part_.is_open(); }

 private:
  std::filesystem::path name_;
  Descriptor part_;  ///< FILE.part, locked
};

/// Writes a whole file as an AtomicFile. Throws WriteError, after removing FILE.part.
void write_file_atomically(const std::filesystem::path& file, std::string_view text);

}  // namespace mssim
