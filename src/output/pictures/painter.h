#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "output/pictures/skin.h"
#include "output/traces/trace_reader.h"
#include "picture/picture.h"
#include "render/draw.h"

namespace mssim {

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
  Picture picture_of(const std::vector<Vec3d>& positions) const;

 private:
  std::vector<Vec3d> points_at(const std::vector<Vec3d>& positions) const;
  Shot shot() const;
  void write_legend(Picture& picture) const;

  const TraceContent& content_;
  PictureOptions options_;
  Camera camera_;
  Skin skin_;
  std::vector<Rgb> colour_;  ///< [parts] unless strain is shown
  std::optional<double> floor_;
  std::optional<Box<double>> seen_, world_;
  double most_strain_ = 0;  ///< in either direction, of the colours' ends
};

}  // namespace mssim
