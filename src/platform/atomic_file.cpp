#include "platform/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
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

[[noreturn]] void refuse(const fs::path& file, const std::string& why, const char* or_do = "") {
  throw WriteError("cannot write " + file.string() + ": " + why + "; " + or_do + "choose another file name");
}

/// What lies below these is not made of files. Shared memory is.
void require_ordinary_folder(const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = fs::weakly_canonical(file.has_parent_path() ? file.parent_path() : ".", ignored);
  const auto begins_with = [&](const fs::path& start) {
    return std::mismatch(start.begin(), start.end(), folder.begin(), folder.end()).first == start.end();
  };
  for (const char* system : {"/dev", "/proc", "/sys"})
    if (begins_with(system) && !begins_with("/dev/shm"))
      refuse(file, std::string("it lies in ") + system + ", which belongs to the system");
}

/// Opens the temporary of `file` and locks it, before a byte of it changes. Follows no link, which could lead
/// to a file of somebody else, and takes no file that has another name or owner, too.
Descriptor open_locked(const fs::path& file) {
  constexpr int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  constexpr mode_t everyone_as_umask_allows = 0666;
  const fs::path temporary = temporary_of(file);
  while (true) {
    Descriptor part(::open(temporary.c_str(), flags | O_CREAT | O_EXCL, everyone_as_umask_allows));
    const bool is_new = part.is_open();
    if (!is_new && errno == EEXIST) {
      part = Descriptor(::open(temporary.c_str(), flags));
      if (!part.is_open() && errno == ENOENT) continue;
      if (!part.is_open() && errno == ELOOP)
        refuse(file, temporary.string() + " is a link", "remove it, or ");
    }
    if (!part.is_open()) fail(file, "creating " + temporary.string());
    if (!part.lock())
      throw WriteError("another mssim is writing " + file.string() +
                       "; wait until it has ended, or choose another file name");
    struct stat opened {};
    struct stat named {};
    if (::fstat(part.get(), &opened) != 0) fail(file, "looking at " + temporary.string());
    // Between opening and locking the writer before may have renamed or removed it.
    if (::lstat(temporary.c_str(), &named) != 0 || opened.st_dev != named.st_dev ||
        opened.st_ino != named.st_ino)
      continue;
    if (is_new) return part;
    if (!S_ISREG(opened.st_mode))
      refuse(file, temporary.string() + " is not a regular file", "remove it, or ");
    if (opened.st_nlink == 1 && opened.st_uid == ::geteuid()) return part;
    if (::unlink(temporary.c_str()) != 0) fail(file, "removing " + temporary.string());
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

fs::path target_of(const fs::path& file) {
  constexpr int most_links = 40;  // as many as Linux follows
  fs::path target = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    require_ordinary_folder(target);
    if (links == most_links) refuse(file, "its links lead round in a circle");
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) throw WriteError(write_failure(file, "following the link", error.value()));
  }
  require_replaceable(target);
  return target;
}

void require_replaceable(const fs::path& file) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
    refuse(file,
           std::string("it exists and is ") + (S_ISDIR(status.st_mode) ? "a folder" : "not a regular file"));
  require_ordinary_folder(file);
}

AtomicFile::AtomicFile(fs::path file) : name_(std::move(file)) {
  require_replaceable(name_);
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
