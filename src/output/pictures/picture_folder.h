#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "output/pictures/painter.h"
#include "platform/files.h"

namespace mssim {

/// A folder of pictures of a run, drawn while it runs: frame-000000.png, frame-000001.png and so on. What
/// comes is not known: where something leaves the picture, the next ones are taken from farther away.
class PictureFolder {
 public:
  /// Creates the folder and those above it. Throws WriteError, also where the folder has something in it or
  /// is another writer's.
  PictureFolder(std::filesystem::path folder, TraceContent content, const PictureOptions& options);
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;

  /// Draws the next moment; positions are [nodes] m. Throws WriteError.
  void draw(const std::vector<Vec3d>& positions);

  const std::filesystem::path& name() const { return folder_; }
  std::size_t pictures() const { return pictures_; }

 private:
  std::filesystem::path folder_;
  FolderLock lock_;
  TraceContent content_;
  PictureOptions options_;
  std::optional<Painter> painter_;  ///< of content_; from the first moment on
  std::size_t pictures_ = 0;
};

}  // namespace mssim
