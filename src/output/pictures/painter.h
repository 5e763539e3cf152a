#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "model/node_shape.h"
#include "output/traces/trace_reader.h"
#include "picture/picture.h"
#include "platform/files.h"
#include "render/draw.h"

namespace mssim {

/// The surface that a picture shows; at a crease several points are the same node.
using Skin = NodeSurface;

/// The skin of nodes of that shape that rest at `start`. Points are divided where a surface of bodies bends
/// by more than 40 degrees there, so that edges are drawn sharp.
Skin skin_of(const NodeShape& shape, const std::vector<Vec3d>& start);

/// What the colours of a picture tell apart.
enum class ColourBy : std::uint8_t {
  object,  ///< the cloth, each body, each layer of a garment
  panel,   ///< each panel of a garment; else as `object`
  strain   ///< how far springs are stretched or compressed, the mean of those of each node
};

struct PictureOptions {
  ViewDirection view;
  std::uint32_t width = 960, height = 720;  ///< pixels, up to most_picture_pixels
  ColourBy colour = ColourBy::object;
  int threads = 1;
};

/// Draws moments of a trace, all from the same place.
class Painter {
 public:
  /// `start`: the positions of the trace's first frame. `content` must outlive it.
  Painter(const TraceContent& content, const std::vector<Vec3d>& start, const PictureOptions& options);

  /// Takes care that every picture shows what is at these positions ([nodes] m), too, and that the colours of
  /// strain reach that far.
  void make_room_for(const std::vector<Vec3d>& positions);

  /// The picture of a moment for which there is room.
  Picture picture_of(const std::vector<Vec3d>& positions, bool with_legend = true) const;

  /// Do colours stand for anything that has to be said?
  bool has_legend() const;
  /// That alone, as large as a picture.
  Picture legend() const;

  /// How every picture is taken: with all for which there is room, and the shadows of it where ground is
  /// seen.
  Shot shot() const;

 private:
  std::vector<Vec3d> points_at(const std::vector<Vec3d>& positions) const;
  void write_legend(Picture& picture) const;

  const TraceContent& content_;
  PictureOptions options_;
  Camera camera_;
  Skin skin_;
  std::vector<Rgb> colour_;  ///< [parts] unless strain is shown
  std::optional<double> floor_;
  std::optional<Box<double>> seen_, world_;
  std::optional<Box<double>> shadow_;  ///< as seen, were the ground at height 0
  double most_strain_ = 0;             ///< in either direction, of the colours' ends
};

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
