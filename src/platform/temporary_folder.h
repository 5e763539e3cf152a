#pragma once

#include <filesystem>

namespace mssim {

/// A new, empty folder in the system's folder for temporary files, which goes away with everything in it.
/// Throws std::runtime_error with one sentence when it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  /// The same in a folder that the caller names.
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Absolute, so that it can be told to a program that runs elsewhere.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// One for the whole process, made when it is first asked for; it goes away when main returns. Throws like
/// TemporaryFolder.
const std::filesystem::path& temporary_folder_of_process();

/// Removes it, if there is one, before a signal ends the process.
void remove_temporary_folder_of_process();

}  // namespace mssim
