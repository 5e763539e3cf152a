#include "output/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>

#include "output/write_error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& action) {
  throw WriteError(write_failure(file, action, errno));
}

/// An open file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (is_open()) ::close(descriptor_);
  }
  bool is_open() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  /// Closes and says whether that worked: some file systems report a failed write only here.
  bool close() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    return ::close(descriptor) == 0;
  }

 private:
  int descriptor_;
};

void write_and_sync(const fs::path& file, const fs::path& temporary, std::string_view text) {
  constexpr mode_t everyone_as_umask_allows = 0666;
  Descriptor out(
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, everyone_as_umask_allows));
  if (!out.is_open()) fail(file, "creating " + temporary.string());
  while (!text.empty()) {
    const ssize_t written = ::write(out.get(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file, "writing " + temporary.string());
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(out.get()) != 0) fail(file, "syncing " + temporary.string());
  if (!out.close()) fail(file, "closing " + temporary.string());
}

void sync_folder_of(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const Descriptor handle(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // A folder that may be written but not read cannot be opened, and some file systems cannot sync folders;
  // the rename is done then, only not yet proof against a power failure.
  if (!handle.is_open()) return;
  if (::fsync(handle.get()) != 0 && errno != EINVAL) fail(file, "syncing folder " + folder.string());
}

void rename_into_place(const fs::path& file) {
  const fs::path temporary = temporary_of(file);
  if (::rename(temporary.c_str(), file.c_str()) != 0) fail(file, "renaming " + temporary.string() + " to it");
  sync_folder_of(file);
}

}  // namespace

fs::path temporary_of(const fs::path& file) {
  fs::path temporary = file;
  temporary += ".part";
  return temporary;
}

void require_replaceable(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return;
  throw WriteError("cannot write " + file.string() + ": it exists and is " +
                   (S_ISDIR(status.st_mode) ? "a folder" : "not a regular file") +
                   "; choose another file name");
}

void move_into_place(const fs::path& file) {
  const fs::path temporary = temporary_of(file);
  Descriptor written(::open(temporary.c_str(), O_RDONLY | O_CLOEXEC));
  if (!written.is_open()) fail(file, "opening " + temporary.string());
  if (::fsync(written.get()) != 0) fail(file, "syncing " + temporary.string());
  if (!written.close()) fail(file, "closing " + temporary.string());
  rename_into_place(file);
}

void write_file_atomically(const fs::path& file, std::string_view text) {
  require_replaceable(file);
  const fs::path temporary = temporary_of(file);
  try {
    write_and_sync(file, temporary, text);
    rename_into_place(file);
  } catch (...) {
    std::error_code ignored;
    if (fs::is_regular_file(temporary, ignored)) fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace mssim
