#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "platform/process.h"
#include "text/error.h"

namespace mssim {

/// Why a file cannot be read as a whole. what() is only the problem, such as "is not a regular file".
struct ReadError : std::runtime_error {
  enum class Cause { missing, not_regular, too_large, other };
  Cause cause;

  ReadError(Cause why, const std::string& problem) : std::runtime_error(problem), cause(why) {}

  /// "FILE: PROBLEM: REMEDY". For the cause `other`, the problem includes its own remedy.
  std::string sentence(const std::filesystem::path& file, std::string_view remedy) const;
};

/// Throws ReadError unless the file exists and is regular.
void require_regular_file(const std::filesystem::path& file);

/// All bytes of a regular file: a pipe would block, a device may never end, and a folder reads as empty.
/// Throws ReadError, also for more than `most_bytes`.
std::string read_file(const std::filesystem::path& file,
                      std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

/// The same, but throws a Failure with the ReadError's sentence(), which `remedy` ends.
template <class Failure>
std::string read_file_or(const std::filesystem::path& file, std::string_view remedy,
                         std::size_t most_bytes = std::numeric_limits<std::size_t>::max()) {
  try {
    return read_file(file, most_bytes);
  } catch (const ReadError& error) {
    throw Failure(error.sentence(file, remedy));
  }
}

/// Thrown if something cannot be written; what() is one sentence with the file, the failed action, the
/// system's reason and a remedy. Commands end with exit code 4.
struct WriteError : ErrorWith<exit_file_error> {
  using ErrorWith::ErrorWith;
};

/// The sentence of a WriteError: "cannot write FILE: ACTION failed: REASON; REMEDY". `error_number` is an
/// errno value; `reason` replaces its text if the caller knows more (for example if a library reports no
/// errno and `error_number` is 0).
std::string write_failure(const std::filesystem::path& file, const std::string& action, int error_number,
                          const std::string& reason = {});

/// The temporary name of `file` until it is complete: FILE.part.
std::filesystem::path temporary_of(const std::filesystem::path& file);

/// End of a WriteError's sentence: FILE.part keeps `count` of `what` ("frames"); empty for none.
std::string kept_in_part(const std::filesystem::path& file, std::string_view what, std::size_t count);

/// Throws UsageError for "-", by which a user means standard output, where no file of mssim goes.
void require_file_name(const std::filesystem::path& file);

/// The file to write for a name given by the user: the file itself, or the target of a link or chain of
/// links. Throws WriteError if the target cannot be replaced or links form a circle, and like
/// require_file_name().
std::filesystem::path target_of(const std::filesystem::path& file);

/// Throws WriteError if `file` exists and is neither a regular file nor a link, because a rename would
/// replace a folder or a device, and if it is in /dev (except /dev/shm), /proc or /sys.
void require_replaceable(const std::filesystem::path& file);

/// A file that one writer at a time writes as FILE.part and renames when complete: at every moment, even
/// after a crash of the machine, FILE is either the whole old or the whole new file. The new file has the
/// permissions of the old one, and its owner may write it. A link in the place of FILE is replaced, not
/// followed, so the content of a folder cannot redirect writes outside. For a file that the user names,
/// target_of() follows links first.
class AtomicFile {
 public:
  /// Creates or empties FILE.part and locks it for this writer. Throws WriteError if another writer of any
  /// process has it, if FILE.part is a link or not a regular file, if it cannot be created, and like
  /// require_replaceable().
  explicit AtomicFile(std::filesystem::path file);
  AtomicFile(AtomicFile&&) = default;
  /// Removes FILE.part unless the writing has ended.
  ~AtomicFile() { remove(); }

  const std::filesystem::path& name() const { return name_; }

  /// Appends to FILE.part. Throws WriteError; FILE.part then ends where it did before.
  void append(std::string_view text);
  /// Syncs FILE.part, which is when some file systems notice that it cannot be written. Throws WriteError.
  void sync();
  /// Ends the writing: syncs FILE.part, renames it to FILE and syncs the folder. On WriteError, FILE.part is
  /// unchanged and still locked.
  void move_into_place();
  /// Ends the writing and leaves the partial FILE.part to the user.
  void keep() { part_ = Descriptor(); }
  /// Ends the writing and removes FILE.part.
  void remove();
  /// Whether the writing has not ended.
  bool is_under_way() const { return part_.is_open(); }

 private:
  std::filesystem::path name_;
  Descriptor part_;  ///< FILE.part, locked
};

/// Writes a whole file with AtomicFile. Throws WriteError, after removing FILE.part.
void write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// A file by its name in a folder.
struct FolderFile {
  std::string name, text;
};

/// Writes all files into a folder, and replaces none before all are written and synced under temporary names.
/// Throws WriteError.
void write_files_atomically(const std::filesystem::path& folder, std::span<const FolderFile> files);

/// Reserves `bytes` after the end of an open file without changing its size, for writers whose files do not
/// survive a failed write. Returns 0 or the errno of the failure; 0 also if the file system cannot reserve.
int reserve_space(int descriptor, std::uint64_t bytes);

/// Releases space that was reserved after the end of a file and not written.
void release_reserved_space(const std::filesystem::path& file);

/// Creates a folder and its parents if missing, and returns its name. Throws WriteError.
const std::filesystem::path& make_folder(const std::filesystem::path& folder);

/// The entries of a folder, by name; empty if it cannot be listed.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

/// Locks a folder for one writer: a second lock on it fails, in any process, while the descriptor is open.
/// Leaves no file, however the process ends. No effect on a file system without locks. Throws WriteError if
/// the folder is already locked or cannot be opened.
Descriptor lock_folder(const std::filesystem::path& folder);

/// A new, empty folder in the system's folder for temporary files; the destructor removes it with its
/// contents. Throws WriteError if it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  /// Makes the folder in `parent`.
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Absolute, so it can be passed to a program that runs in another folder.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The temporary folder of the process, made on first use and removed when main returns. Throws like
/// TemporaryFolder.
const std::filesystem::path& temporary_folder_of_process();

/// Removes that folder, if it exists, before a signal ends the process.
void remove_temporary_folder_of_process();

/// The folder of the files that mssim reads at run time (`kernels`, `scenes`, `published`): share/mssim next
/// to the folder of the running program, both in the build tree and in an installation. Throws
/// std::runtime_error with one sentence if it is missing.
std::filesystem::path data_folder();

/// A folder of the user by the XDG base directory specification: the value of `variable`, or `in_home` in the
/// home folder; empty if the user has neither. Relative paths are ignored, as the specification requires.
std::filesystem::path xdg_folder(const char* variable, std::string_view in_home);

/// The folder of that name in mssim's part of the user's cache folder, $XDG_CACHE_HOME or ~/.cache; empty if
/// the user has neither.
std::filesystem::path cache_folder(std::string_view name);

/// A helper program that mssim runs: in `libexec/mssim` next to the program's `bin` folder. Throws
/// std::runtime_error if this program cannot be found.
std::filesystem::path helper_program(std::string_view name);

/// mssim itself, to be run as another process: the program in `bin`, or, under an emulator, the helper that
/// starts it. Throws like helper_program.
std::filesystem::path mssim_program();

/// The file that the shell would run for this name: the first executable one in the folders of PATH; for a
/// name with a slash, the file at that path. Absolute; nothing if there is none.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Why the system did not execute this file, given errno: the end of a sentence. execve has the same errno
/// for a missing interpreter as for a missing program.
std::string why_not_executed(const std::filesystem::path& file, int error);

/// Whether the file is a script whose first line ends in CR LF: then the name of its interpreter, or of that
/// one's last argument, ends in a carriage return.
bool names_interpreter_with_return(const std::filesystem::path& file);

}  // namespace mssim
