#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "platform/process.h"
#include "text/error.h"

namespace mssim {

/// Why a file cannot be read as a whole. what() is the problem alone, such as "is not a regular file".
struct ReadError : std::runtime_error {
  enum class Cause { missing, not_regular, too_large, other };
  Cause cause;

  ReadError(Cause why, const std::string& problem) : std::runtime_error(problem), cause(why) {}

  /// "FILE: PROBLEM: REMEDY". The problem says itself what to do about an `other` cause.
  std::string sentence(const std::filesystem::path& file, std::string_view remedy) const;
};

/// Throws ReadError unless there is such a file and it is a regular one.
void require_regular_file(const std::filesystem::path& file);

/// All bytes of a regular file: a pipe would block, a device may never end, and a folder reads as nothing.
/// Throws ReadError, also where there are more than `most_bytes`.
std::string read_file(const std::filesystem::path& file,
                      std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

/// Thrown when something cannot be written; what() is one sentence that names the file, what failed, the
/// system's reason and what to do about it. Commands end with exit code 4.
struct WriteError : ErrorWith<exit_file_error> {
  using ErrorWith::ErrorWith;
};

/// The sentence for a WriteError: "cannot write FILE: ACTION failed: REASON; REMEDY".
/// `error_number` is an errno value; `reason` replaces its text where the caller knows more (for example when
/// a library reports no errno and `error_number` is 0).
std::string write_failure(const std::filesystem::path& file, const std::string& action, int error_number,
                          const std::string& reason = {});

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

/// Asks the file system for room for `bytes` more behind the end of an open file, whose size stays as it is,
/// so that a writer whose files do not survive a failed write can learn before it writes. Returns 0, or the
/// errno of the reason why there is no room. File systems that cannot reserve answer 0.
int reserve_space(int descriptor, std::uint64_t bytes);

/// Gives back what was reserved behind the end of a file and not written.
void release_reserved_space(const std::filesystem::path& file);

/// Creates a folder and those above it, where they are not there, and returns its name. Throws WriteError.
const std::filesystem::path& make_folder(const std::filesystem::path& folder);

/// Keeps a folder for one writer: a second lock on it fails, in any process, while the first lives. Leaves no
/// file behind, whatever ends the process. On a file system that knows no locks it does nothing.
class FolderLock {
 public:
  /// Throws WriteError when the folder is locked already or cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  Descriptor folder_;
};

/// A new, empty folder in the system's folder for temporary files, which goes away with everything in it.
/// Throws std::runtime_error with one sentence when it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  /// Makes the folder in one that the caller names.
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Absolute, so that it can be told to a program that runs elsewhere.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// One for the whole process, made when it is first asked for; it goes away when main returns. Throws like
/// TemporaryFolder.
const std::filesystem::path& temporary_folder_of_process();

/// Removes it, if there is one, before a signal ends the process.
void remove_temporary_folder_of_process();

/// The folder of what mssim reads at run time (`kernels`, `scenes`, `published`): share/mssim beside the
/// folder that holds the running program, in the build tree as in an installation. Throws std::runtime_error
/// with one sentence when it is missing.
std::filesystem::path data_folder();

/// The folder of that name in mssim's part of the user's cache folder, $XDG_CACHE_HOME or ~/.cache; empty
/// where the user has neither.
std::filesystem::path cache_folder(std::string_view name);

/// A program of mssim's that it runs itself: `libexec/mssim` beside the program's `bin` folder holds it.
/// Throws std::runtime_error when this program cannot be found.
std::filesystem::path helper_program(std::string_view name);

/// mssim itself, for a process of its own: in `bin` or, where an emulator runs it, what calls that among the
/// helpers. Throws like helper_program.
std::filesystem::path mssim_program();

/// The file that the shell would run for this name: the first one in the folders of PATH that may be
/// executed; of a name with a slash, the file of that path. Absolute; none where there is none.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Why the system has not executed this file, with that errno: the end of a sentence. For a missing
/// interpreter execve says the same as for a missing program.
std::string why_not_executed(const std::filesystem::path& file, int error);

/// Whether the file is a script whose first line ends as Windows has it: its interpreter, or the last
/// argument of that, then has a name that ends with a carriage return.
bool names_interpreter_with_return(const std::filesystem::path& file);

}  // namespace mssim
