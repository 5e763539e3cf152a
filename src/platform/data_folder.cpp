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

/// What `bin`, which has mssim, and `libexec/mssim`, which has its helpers, lie in.
std::filesystem::path own_prefix() {
  const std::filesystem::path folder = own_program().parent_path();
  return folder.parent_path().filename() == "libexec" ? folder.parent_path().parent_path()
                                                      : folder.parent_path();
}

}  // namespace

std::filesystem::path data_folder() {
  std::error_code error;
  std::filesystem::path folder = own_prefix() / "share" / "mssim";
  if (!std::filesystem::is_directory(folder, error))
    throw std::runtime_error(
        "the data folder " + folder.string() + " of " + own_program().string() +
        " is missing: run mssim from its build tree or from where `cmake --install` put it");
  return folder;
}

std::filesystem::path helper_program(std::string_view name) {
  return own_prefix() / "libexec" / "mssim" / name;
}

std::filesystem::path mssim_program() {
  std::error_code error;
  const std::filesystem::path emulated = helper_program("mssim");
  return std::filesystem::exists(emulated, error) ? emulated : own_prefix() / "bin" / "mssim";
}

}  // namespace mssim
