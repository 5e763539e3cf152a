#include "platform/file_space.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace mssim {

int reserve_space(int descriptor, std::uint64_t bytes) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return errno;
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0) return errno;
  // fallocate() heeds this limit only when it changes the file's size.
  if (limit.rlim_cur != RLIM_INFINITY && static_cast<std::uint64_t>(status.st_size) + bytes > limit.rlim_cur)
    return EFBIG;
  int result = 0;
  do {
    result = ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, status.st_size, static_cast<off_t>(bytes));
  } while (result != 0 && errno == EINTR);
  if (result == 0 || errno == EOPNOTSUPP || errno == ENOSYS) return 0;
  return errno;
}

void release_reserved_space(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto size = std::filesystem::file_size(file, ignored);
  if (!ignored) std::filesystem::resize_file(file, size, ignored);
}

}  // namespace mssim
