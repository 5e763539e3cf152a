#pragma once

#include <filesystem>

#include "platform/descriptor.h"

namespace mssim {

/// Creates a folder and those above it, where they are not there, and returns its name. Throws WriteError.
const std::filesystem::path& make_folder(const std::filesystem::path& folder);

/// Keeps a folder for one writer: a second lock on it fails, in any process, while the first lives. Leaves no
/// file behind, whatever ends the process. On a file system that knows no locks it does nothing.
class FolderLock {
 public:
  /// Throws WriteError when the folder is locked already or cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  Descriptor folder_;
};

}  // namespace mssim
