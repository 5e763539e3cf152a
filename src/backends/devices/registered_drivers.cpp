#include "backends/devices/registered_drivers.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr const char* usual_folder = "/etc/OpenCL/vendors";

std::optional<fs::path> path_from(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

RegisteredDriver registered_by(const fs::path& icd_file) {
  std::string library;
  std::ifstream(icd_file) >> library;
  return {icd_file, library};
}

std::vector<RegisteredDriver> registered_in(const fs::path& folder) {
  std::vector<RegisteredDriver> drivers;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".icd") drivers.push_back(registered_by(entry->path()));
  std::ranges::sort(drivers, {}, &RegisteredDriver::file);
  return drivers;
}

}  // namespace

std::vector<RegisteredDriver> registered_drivers() {
  std::error_code error;
  const auto chosen = path_from("OCL_ICD_VENDORS");
  if (!chosen) return registered_in(path_from("OPENCL_VENDOR_PATH").value_or(usual_folder));
  if (fs::is_directory(*chosen, error)) return registered_in(*chosen);
  if (chosen->extension() != ".icd") return {{*chosen, chosen->string()}};
  return {registered_by(chosen->has_parent_path() ? *chosen : usual_folder / *chosen)};
}

bool is_pocl(const RegisteredDriver& driver) {
  return driver.shared_library.find("pocl") != std::string::npos;
}

}  // namespace mssim
