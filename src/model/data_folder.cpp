#include "model/data_folder.h"

#include <stdexcept>
#include <system_error>

namespace mssim {

std::filesystem::path data_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error)
    throw std::runtime_error("mssim cannot find its own program file through /proc/self/exe (" +
                             error.message() + "), beside which its data folder lies");
  std::filesystem::path folder = program.parent_path().parent_path() / "share" / "mssim";
  if (!std::filesystem::is_directory(folder, error))
    throw std::runtime_error(
        "the data folder " + folder.string() + " of " + program.string() +
        " is missing: run mssim from its build tree or from where `cmake --install` put it");
  return folder;
}

}  // namespace mssim
