#include "platform/folder_lock.h"

#include <fcntl.h>

#include <cerrno>

#include "platform/write_error.h"

namespace mssim {

const std::filesystem::path& make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw WriteError(write_failure(folder, "creating the folder", error.value()));
  return folder;
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (!folder_.is_open()) throw WriteError(write_failure(folder, "opening the folder", errno));
  if (!folder_.lock())
    throw WriteError("another mssim is writing into " + folder.string() +
                     "; wait until it has ended, or choose another folder");
}

}  // namespace mssim
