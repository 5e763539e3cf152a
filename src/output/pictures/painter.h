#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "geometry/vec3.h"
#include "model/node_shape.h"
#include "output/traces/trace_reader.h"
#include "picture/picture.h"
#include "platform/files.h"
#include "render/draw.h"

namespace mssim {

/// The surface in a picture of nodes of that shape with rest positions `start`. Where a surface of bodies
/// bends by more than 40 degrees, several points belong to the same node, so that edges are drawn sharp.
NodeSurface skin_of(const NodeShape& shape, const std::vector<Vec3d>& start);

/// Meaning of the colours of a picture.
enum class ColourBy : std::uint8_t {
  object,  ///< the cloth, each body, each layer of a garment
  panel,   ///< each panel of a garment; else as `object`
  strain   ///< mean strain of the springs at each node
};

/// How pictures are drawn: from where, how large, what colours mean, and by how many threads.
struct PictureOptions {
  ViewDirection view;
  std::uint32_t width = 960, height = 720;  ///< pixels, up to most_picture_pixels
  ColourBy colour = ColourBy::object;
  int threads = 1;
};

/// Draws moments of a trace, all from the same direction.
class Painter {
 public:
  /// `start`: the positions of the trace's first frame. `content` must outlive it.
  Painter(const TraceContent& content, const std::vector<Vec3d>& start, const PictureOptions& options);

  /// Extends the region of every picture, and the range of strain colours, to these positions ([nodes] m).
  void make_room_for(const std::vector<Vec3d>& positions);

  /// The picture of a moment for which there is room.
  Picture picture_of(const std::vector<Vec3d>& positions, bool with_legend = true) const;

  /// Whether the colours have a legend: those of strain, and those of two to eight panels, which all differ.
  bool has_legend() const;
  /// Only the legend, as large as a picture.
  Picture legend() const;

  /// The shot of every picture: all positions for which there is room and, if ground is visible, their
  /// shadows.
  Shot shot() const;

 private:
  std::vector<Vec3d> points_at(const std::vector<Vec3d>& positions) const;
  void write_legend(Picture& picture) const;

  const TraceContent& content_;
  PictureOptions options_;
  Camera camera_;
  NodeSurface skin_;
  std::vector<Rgb> colour_;  ///< [parts] unless strain is shown
  std::optional<double> floor_;
  std::optional<Box<double>> seen_, world_;
  std::optional<Box<double>> shadow_;  ///< as seen if the ground were at height 0
  double most_strain_ = 0;             ///< at the ends of the colours, in both directions
};

/// A folder of pictures drawn during a run: frame-000000.png, frame-000001.png and so on. Later positions are
/// unknown: if something leaves the picture, the following ones are taken from farther away.
class PictureFolder {
 public:
  /// Creates the folder and its parents. Throws UsageError if the folder is not empty; WriteError, also if
  /// another writer has it.
  PictureFolder(std::filesystem::path folder, TraceContent content, const PictureOptions& options);
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;

  /// Draws the next moment; positions are [nodes] m. Throws WriteError.
  void draw(const std::vector<Vec3d>& positions);

  const std::filesystem::path& name() const { return folder_; }
  std::size_t pictures() const { return pictures_; }

 private:
  std::filesystem::path folder_;
  Descriptor lock_;  ///< of the folder
  TraceContent content_;
  PictureOptions options_;
  std::optional<Painter> painter_;  ///< of content_; none before the first moment
  std::size_t pictures_ = 0;
};

}  // namespace mssim
