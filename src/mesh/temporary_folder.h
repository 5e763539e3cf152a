#pragma once

#include <filesystem>

namespace mssim {

/// A new, empty folder in the system's folder for temporary files, which goes away with everything in it.
/// Throws std::runtime_error with one sentence when it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace mssim
