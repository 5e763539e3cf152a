#include "platform/data_folder.h"

#include <stdexcept>
#include <system_error>

namespace mssim {

namespace {

std::filesystem::path own_program() {
  std::error_code error;
  std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error)
    throw std::runtime_error("mssim cannot find its own program file through /proc/self/exe (" +
                             error.message() + "), beside which its data folder lies");
  return program;
}

}  // namespace

std::filesystem::path data_folder() {
  std::error_code error;
  const std::filesystem::path program = own_program();
  std::filesystem::path folder = program.parent_path().parent_path() / "share" / "mssim";
  if (!std::filesystem::is_directory(folder, error))
    throw std::runtime_error(
        "the data folder " + folder.string() + " of " + program.string() +
        " is missing: run mssim from its build tree or from where `cmake --install` put it");
  return folder;
}

std::filesystem::path helper_program(std::string_view name) {
  return own_program().parent_path().parent_path() / "libexec" / "mssim" / name;
}

}  // namespace mssim
