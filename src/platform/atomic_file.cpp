#include "platform/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "platform/write_error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& action) {
  throw WriteError(write_failure(file, action, errno));
}

/// Whether the open file is the one that stands under this name.
bool is_named(const Descriptor& open, const fs::path& name) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(open.get(), &opened) == 0 && ::stat(name.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Opens the temporary of `file` and locks it, before a byte of it changes.
Descriptor open_locked(const fs::path& file) {
  constexpr mode_t everyone_as_umask_allows = 0666;
  const fs::path temporary = temporary_of(file);
  while (true) {
    Descriptor part(::open(temporary.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, everyone_as_umask_allows));
    if (!part.is_open()) fail(file, "creating " + temporary.string());
    if (!part.lock())
      throw WriteError("another mssim is writing " + file.string() +
                       "; wait until it has ended, or choose another file name");
    // Between opening and locking the writer before may have renamed or removed it.
    if (is_named(part, temporary)) return part;
  }
}

void sync_folder_of(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const Descriptor handle(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // A folder that may be written but not read cannot be opened, and some file systems cannot sync folders;
  // the rename is done then, only not yet proof against a power failure.
  if (!handle.is_open()) return;
  if (::fsync(handle.get()) != 0 && errno != EINVAL) fail(file, "syncing folder " + folder.string());
}

}  // namespace

fs::path temporary_of(const fs::path& file) {
  fs::path temporary = file;
  temporary += ".part";
  return temporary;
}

std::string kept_in_part(const fs::path& file, std::string_view what, std::size_t count) {
  if (count == 0) return "";
  return "; " + temporary_of(file).string() + " keeps the " + std::string(what) +
         " written before: " + std::to_string(count);
}

void require_replaceable(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return;
  throw WriteError("cannot write " + file.string() + ": it exists and is " +
                   (S_ISDIR(status.st_mode) ? "a folder" : "not a regular file") +
                   "; choose another file name");
}

AtomicFile::AtomicFile(fs::path file) : name_(std::move(file)) {
  require_replaceable(name_);
  require_replaceable(temporary_of(name_));
  part_ = open_locked(name_);
  if (::ftruncate(part_.get(), 0) != 0) fail(name_, "emptying " + temporary_of(name_).string());
}

void AtomicFile::remove() {
  if (!is_under_way()) return;
  std::error_code ignored;
  fs::remove(temporary_of(name_), ignored);
  part_ = Descriptor();
}

void AtomicFile::append(std::string_view text) {
  const off_t end = ::lseek(part_.get(), 0, SEEK_END);
  while (!text.empty()) {
    const ssize_t written = ::write(part_.get(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      static_cast<void>(::ftruncate(part_.get(), end));
      throw WriteError(write_failure(name_, "writing " + temporary_of(name_).string(), error));
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::move_into_place() {
  const fs::path temporary = temporary_of(name_);
  if (::fsync(part_.get()) != 0) fail(name_, "syncing " + temporary.string());
  if (::rename(temporary.c_str(), name_.c_str()) != 0)
    fail(name_, "renaming " + temporary.string() + " to it");
  const bool closed = part_.close();
  if (!closed) fail(name_, "closing it");
  sync_folder_of(name_);
}

void write_file_atomically(const fs::path& file, std::string_view text) {
  AtomicFile written(file);
  written.append(text);
  written.move_into_place();
}

}  // namespace mssim
