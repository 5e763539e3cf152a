#include "platform/write_error.h"

#include <cerrno>
#include <system_error>

namespace mssim {
namespace {

const char* remedy(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another folder";
    case EFBIG:
      return "raise the limit on file sizes (ulimit -f) or write less";
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

}  // namespace

std::string write_failure(const std::filesystem::path& file, const std::string& action, int error_number,
                          const std::string& reason) {
  const std::string why = !reason.empty() ? reason : std::generic_category().message(error_number);
  return "cannot write " + file.string() + ": " + action + " failed: " + why + "; " + remedy(error_number);
}

}  // namespace mssim
