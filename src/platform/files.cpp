#include "platform/files.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using Cause = ReadError::Cause;

[[noreturn]] void fail(const std::string& what, const std::error_code& error, const std::string& remedy) {
  throw ReadError(Cause::other, fmt::format("{} ({}): {}", what, error.message(), remedy));
}

std::error_code last_error() { return {errno, std::generic_category()}; }

[[noreturn]] void refuse_size(std::size_t most_bytes) {
  constexpr std::size_t mebibyte = std::size_t{1} << 20;
  throw ReadError(Cause::too_large, most_bytes < mebibyte
                                        ? fmt::format("is longer than {} KiB", most_bytes >> 10)
                                        : fmt::format("is longer than {} MiB", most_bytes >> 20));
}

const char* remedy(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another folder";
    case EFBIG:
      return "raise the limit on file sizes (ulimit -f) or write less";
    case EMFILE:
    case ENFILE:
      return "raise the limit of open files (ulimit -n)";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    case ENOENT:
      return "create its folder first or choose another one";
    case ENOTDIR:
    case EISDIR:
    case ENAMETOOLONG:
      return "choose another file name";
    default:
      return "choose another folder";
  }
}

[[noreturn]] void fail(const fs::path& file, const std::string& action) {
  throw WriteError(write_failure(file, action, errno));
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why, const char* or_do = "") {
  throw WriteError("cannot write {}: {}; {}choose another file name", file.string(), why, or_do);
}

/// Files in these system folders cannot be replaced; shared memory can.
void require_ordinary_folder(const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = fs::weakly_canonical(file.has_parent_path() ? file.parent_path() : ".", ignored);
  const auto begins_with = [&](const fs::path& start) {
    return std::mismatch(start.begin(), start.end(), folder.begin(), folder.end()).first == start.end();
  };
  for (const char* system : {"/dev", "/proc", "/sys"})
    if (begins_with(system) && !begins_with("/dev/shm"))
      refuse(file, fmt::format("it is in {}, which belongs to the system", system));
}

/// Opens and locks the temporary of `file` before changing it. Follows no link, which could lead to another
/// user's file, and does not reuse a file with another name or owner.
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
      throw WriteError("another mssim is writing {}; wait until it has ended, or choose another file name",
                       file.string());
    struct stat opened {};
    struct stat named {};
    if (::fstat(part.get(), &opened) != 0) fail(file, "inspecting " + temporary.string());
    // Before the lock, the previous writer may have renamed or removed it.
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
  // A folder may be writable but not readable, and some file systems cannot sync folders; then the rename is
  // done, but may not survive a power failure.
  if (!handle.is_open()) return;
  if (::fsync(handle.get()) != 0 && errno != EINVAL) fail(file, "syncing folder " + folder.string());
}

std::optional<TemporaryFolder>& folder_of_process() {
  static std::optional<TemporaryFolder> folder;
  return folder;
}

fs::path own_program() {
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error)
    throw std::runtime_error("mssim cannot find its own program file through /proc/self/exe (" +
                             error.message() + "), from which its data folder is found");
  return program;
}

/// The folder of `bin`, which has mssim, and `libexec/mssim`, which has its helpers.
fs::path own_prefix() {
  const fs::path folder = own_program().parent_path();
  return folder.parent_path().filename() == "libexec" ? folder.parent_path().parent_path()
                                                      : folder.parent_path();
}

bool may_be_executed(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

/// First line of a script, from #! on; empty if the file is not a script.
std::string first_line(const fs::path& file) {
  std::array<char, 256> bytes{};  // no system reads more of it
  std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size() - 1);
  std::string line(bytes.data());
  line.resize(std::min(line.find('\n'), line.size()));
  return line.starts_with("#!") ? line : "";
}

}  // namespace

std::string ReadError::sentence(const fs::path& file, std::string_view remedy) const {
  std::string text = printable(file.string(), 1000) + ": " + what();
  if (cause != Cause::other) text.append(": ").append(remedy);
  return text;
}

void require_regular_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw ReadError(Cause::missing, "there is no such file");
  if (error) fail("cannot be accessed", error, "check the path and its permissions");
  if (!fs::is_regular_file(status)) throw ReadError(Cause::not_regular, "is not a regular file");
}

std::string read_file(const fs::path& file, std::size_t most_bytes) {
  require_regular_file(file);
  const Descriptor open(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!open.is_open()) fail("cannot be opened", last_error(), "check its permissions");
  std::error_code error;
  if (const std::uintmax_t bytes = fs::file_size(file, error); !error && bytes > most_bytes)
    refuse_size(most_bytes);
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  // Count the length while reading too: the file system's length can be wrong (/proc).
  while (true) {
    const ssize_t bytes = ::read(open.get(), block.data(), block.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) fail("cannot be read", last_error(), "check the file and its disk");
    if (bytes == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(bytes));
    if (text.size() > most_bytes) refuse_size(most_bytes);
  }
}

std::string write_failure(const fs::path& file, const std::string& action, int error_number,
                          const std::string& reason) {
  const std::string why = !reason.empty() ? reason : std::generic_category().message(error_number);
  return fmt::format("cannot write {}: {} failed: {}; {}", file.string(), action, why, remedy(error_number));
}

fs::path temporary_of(const fs::path& file) {
  fs::path temporary = file;
  temporary += ".part";
  return temporary;
}

std::string kept_in_part(const fs::path& file, std::string_view what, std::size_t count) {
  if (count == 0) return "";
  return fmt::format("; {} keeps the {} written before: {}", temporary_of(file).string(), what, count);
}

void require_file_name(const fs::path& file) {
  if (file == "-")
    throw UsageError(
        "cannot write -: no file is written to standard output; give another name, or ./- for a file that is "
        "called so");
}

fs::path target_of(const fs::path& file) {
  require_file_name(file);
  constexpr int most_links = 40;  // Linux's limit
  fs::path target = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    require_ordinary_folder(target);
    if (links == most_links) refuse(file, "its links form a circle");
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
  struct stat old {};
  if (::lstat(name_.c_str(), &old) == 0 && S_ISREG(old.st_mode)) {
    // Some file systems have no permissions. This writer may need to open the file again.
    constexpr mode_t permissions = 0777, of_writer = 0600;
    static_cast<void>(::fchmod(part_.get(), (old.st_mode & permissions) | of_writer));
  }
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

void AtomicFile::sync() {
  if (::fsync(part_.get()) != 0) fail(name_, "syncing " + temporary_of(name_).string());
}

void AtomicFile::move_into_place() {
  sync();
  const fs::path temporary = temporary_of(name_);
  if (::rename(temporary.c_str(), name_.c_str()) != 0)
    fail(name_, fmt::format("renaming {} to it", temporary.string()));
  const bool closed = part_.close();
  if (!closed) fail(name_, "closing it");
  sync_folder_of(name_);
}

void write_file_atomically(const fs::path& file, std::string_view text) {
  AtomicFile written(file);
  written.append(text);
  written.move_into_place();
}

void write_files_atomically(const fs::path& folder, std::span<const FolderFile> files) {
  std::vector<AtomicFile> written;
  written.reserve(files.size());
  for (const FolderFile& file : files) written.emplace_back(folder / file.name).append(file.text);
  for (AtomicFile& file : written) file.sync();
  for (AtomicFile& file : written) file.move_into_place();
}

int reserve_space(int descriptor, std::uint64_t bytes) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return errno;
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0) return errno;
  // fallocate() obeys this limit only if it changes the file's size.
  if (limit.rlim_cur != RLIM_INFINITY && static_cast<std::uint64_t>(status.st_size) + bytes > limit.rlim_cur)
    return EFBIG;
  int result = 0;
  do {
    result = ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, status.st_size, static_cast<off_t>(bytes));
  } while (result != 0 && errno == EINTR);
  if (result == 0 || errno == EOPNOTSUPP || errno == ENOSYS) return 0;
  return errno;
}

void release_reserved_space(const fs::path& file) {
  std::error_code ignored;
  const auto size = fs::file_size(file, ignored);
  if (!ignored) fs::resize_file(file, size, ignored);
}

const fs::path& make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw WriteError(write_failure(folder, "creating the folder", error.value()));
  return folder;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    entries.push_back(entry->path());
  std::ranges::sort(entries);
  return entries;
}

Descriptor lock_folder(const fs::path& folder) {
  Descriptor open(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!open.is_open()) throw WriteError(write_failure(folder, "opening the folder", errno));
  if (!open.lock())
    throw WriteError("another mssim is writing into {}; wait until it has ended, or choose another folder",
                     folder.string());
  return open;
}

TemporaryFolder::TemporaryFolder() : TemporaryFolder(variable("TMPDIR", "/tmp")) {}

TemporaryFolder::TemporaryFolder(const fs::path& parent) {
  std::error_code none;  // if this process's folder is gone, keep the name; nothing is created
  const fs::path whole = fs::absolute(parent, none);
  std::string name = ((none ? parent : whole) / "mssim-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw WriteError(
        "cannot make a temporary folder in {} ({}); set TMPDIR to a writable folder whose path is short",
        parent.string(), std::strerror(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

const fs::path& temporary_folder_of_process() {
  auto& folder = folder_of_process();
  if (!folder) folder.emplace();
  return folder->path();
}

void remove_temporary_folder_of_process() { folder_of_process().reset(); }

fs::path data_folder() {
  std::error_code error;
  fs::path folder = own_prefix() / "share" / "mssim";
  if (!fs::is_directory(folder, error))
    throw std::runtime_error(
        "the data folder " + folder.string() + " of " + own_program().string() +
        " is missing: run mssim from its build tree or from its installation (cmake --install)");
  return folder;
}

fs::path xdg_folder(const char* variable, std::string_view in_home) {
  const char* xdg = std::getenv(variable);
  if (xdg && *xdg == '/') return xdg;
  const char* home = std::getenv("HOME");
  if (home && *home == '/') return fs::path(home) / in_home;
  return {};
}

fs::path cache_folder(std::string_view name) {
  const fs::path folder = xdg_folder("XDG_CACHE_HOME", ".cache");
  return folder.empty() ? folder : folder / "mssim" / name;
}

fs::path helper_program(std::string_view name) { return own_prefix() / "libexec" / "mssim" / name; }

fs::path mssim_program() {
  std::error_code error;
  const fs::path emulated = helper_program("mssim");
  return fs::exists(emulated, error) ? emulated : own_prefix() / "bin" / "mssim";
}

std::optional<fs::path> find_program(const std::string& name) {
  if (name.find('/') != std::string::npos)
    return may_be_executed(name) ? std::optional(fs::absolute(name)) : std::nullopt;
  std::istringstream folders(variable("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path candidate = fs::path(folder.empty() ? "." : folder) / name;
    if (may_be_executed(candidate)) return fs::absolute(candidate);
  }
  return std::nullopt;
}

bool names_interpreter_with_return(const fs::path& file) { return first_line(file).ends_with('\r'); }

std::string why_not_executed(const fs::path& file, int error) {
  const std::string reason = fmt::format(" ({})", std::strerror(error));
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return "it is a folder";
  if (names_interpreter_with_return(file))
    return "its lines end in CR LF, as on Windows, and so does the name of its interpreter; save it with "
           "lines that end in LF (sed -i 's/\\r$//')";
  if (error == ENOENT && !fs::exists(file, ignored)) return "there is no such file";
  if (error == EACCES && ::access(file.c_str(), X_OK) != 0) return "it is not executable (chmod +x)";
  if (error == ENOEXEC)
    return "it is neither a program for this machine nor a script whose first line names an interpreter "
           "(#!/usr/bin/env python3)";
  std::string line = first_line(file);
  if (line.empty()) return "the system refuses to start it" + reason;
  line = line.substr(std::min(line.find_first_not_of(" \t", 2), line.size()), 200);
  return "its interpreter " + line.substr(0, line.find_first_of(" \t")) + " cannot be started" + reason;
}

}  // namespace mssim
