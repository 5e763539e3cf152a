#include "platform/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

namespace mssim {
namespace {

std::optional<TemporaryFolder>& folder_of_process() {
  static std::optional<TemporaryFolder> folder;
  return folder;
}

/// The system's folder for temporary files.
std::filesystem::path system_folder() {
  const char* chosen = std::getenv("TMPDIR");
  return chosen && *chosen ? chosen : "/tmp";
}

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(system_folder()) {}

TemporaryFolder::TemporaryFolder(const std::filesystem::path& parent) {
  std::error_code none;  // where this process's folder is gone, the name stays as it is, and nothing is made
  const std::filesystem::path whole = std::filesystem::absolute(parent, none);
  std::string name = ((none ? parent : whole) / "mssim-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw std::runtime_error("cannot make a temporary folder in " + parent.string() + " (" +
                             std::strerror(errno) + "); set TMPDIR to a writable folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

const std::filesystem::path& temporary_folder_of_process() {
  auto& folder = folder_of_process();
  if (!folder) folder.emplace();
  return folder->path();
}

void remove_temporary_folder_of_process() { folder_of_process().reset(); }

}  // namespace mssim
