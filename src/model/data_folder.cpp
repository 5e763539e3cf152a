#include "model/data_folder.h"

#include <stdexcept>

namespace mssim {

std::filesystem::path data_folder() {
  const std::filesystem::path executable = std::filesystem::read_symlink("/proc/self/exe");
  std::filesystem::path folder = executable.parent_path().parent_path() / "share" / "mssim";
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(
        folder.string() + ": the data folder of " + executable.string() +
        " is missing: install mssim with `cmake --install`, or run it from its build folder");
  return folder;
}

}  // namespace mssim
