#pragma once

#include <stdlib.h>

#include <fstream>
#include <initializer_list>

#include "platform/files.h"
#include "tests/support/testing.h"

namespace mssim {

/// A test with an empty folder of its own, removed afterwards.
class TemporaryFolderTest : public testing::Test {
 protected:
  const std::filesystem::path& folder() const { return folder_.path(); }

  /// Writes a file in the folder, with the folders that it lies in. Returns its path.
  std::filesystem::path put(const std::filesystem::path& name, std::string_view text) const {
    std::filesystem::create_directories((folder() / name).parent_path());
    std::ofstream(folder() / name, std::ios::binary) << text;
    return folder() / name;
  }

 private:
  const TemporaryFolder folder_;
};

/// Variables of the environment that a test changes: puts them back.
class KeptVariables {
 public:
  explicit KeptVariables(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      const char* value = ::getenv(name);
      before_.emplace_back(name, value ? std::optional<std::string>(value) : std::nullopt);
    }
  }
  ~KeptVariables() {
    for (const auto& [name, value] : before_) value ? ::setenv(name, value->c_str(), 1) : ::unsetenv(name);
  }
  KeptVariables(const KeptVariables&) = delete;
  KeptVariables& operator=(const KeptVariables&) = delete;

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

/// The committed files, for tests.
std::filesystem::path source_file(std::string_view relative);

/// `text` with its one `old_part` replaced; a test that replaces nothing would test nothing.
inline std::string with_change(std::string text, std::string_view old_part, std::string_view new_part) {
  const std::size_t place = text.find(old_part);
  if (place == std::string::npos || text.find(old_part, place + 1) != std::string::npos)
    throw std::runtime_error("not exactly once in the text: " + std::string(old_part));
  return text.replace(place, old_part.size(), new_part);
}

}  // namespace mssim
