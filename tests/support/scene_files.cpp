#include <filesystem>
#include <string_view>

#include "tests/support/files_fixture.h"

namespace mssim {

std::filesystem::path source_file(std::string_view relative) {
  return std::filesystem::path(MSSIM_SOURCE_DIR) / relative;
}

}  // namespace mssim
