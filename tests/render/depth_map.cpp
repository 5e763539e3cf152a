// Writes the depths that mssim's rasteriser finds in the last frame of a trace, for vtk_test.sh:
//   depth_map TRACE AZIMUTH,ELEVATION WIDTH HEIGHT FILE
// FILE gets doubles: the left and the lower edge of such a picture of `mssim render` and the distance of the
// points that it is drawn at, m as the camera sees them; then one for each point, row by row from the lowest:
// metres towards the camera from the trace's origin, or a NaN where nothing is.
#include <cstdint>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/depth_raster.h"
#include "output/pictures/painter.h"
#include "output/traces/trace_reader.h"
#include "render/draw.h"

namespace mssim {
namespace {

/// What a picture of the last frame shows.
Surface last_surface(const TraceReader& trace) {
  const TraceContent& content = trace.content();
  const std::vector<Vec3d> position = trace.positions(trace.frames() - 1);
  const NodeSurface skin = skin_of(content.shape, trace.positions(0));
  Surface surface{{}, skin.triangles};
  for (const std::uint32_t node : skin.node) surface.points.push_back(position[node]);
  const auto first = static_cast<std::uint32_t>(surface.points.size());
  for (const Vec3d& point : content.body.points) surface.points.push_back(point);
  for (const auto& [a, b, c] : content.body.triangles)
    surface.triangles.push_back({first + a, first + b, first + c});
  return surface;
}

Shot shot_of(const TraceReader& trace, const PictureOptions& options) {
  Painter painter(trace.content(), trace.positions(0), options);
  painter.make_room_for(trace.positions(trace.frames() - 1));
  return painter.shot();
}

void write_depths(Surface surface, const Shot& shot, const std::string& file) {
  const Camera camera(shot.direction);
  for (Vec3d& point : surface.points) point = camera.seen(point);
  const PixelGrid grid = drawn_points(shot);
  std::ofstream out(file, std::ios::binary);
  const auto write = [&](double value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const double value : {grid.left, grid.bottom, grid.pixel}) write(value);
  for (const Fragment& fragment : rasterise(surface, grid, ViewFrom::front))
    write(fragment.triangle != Fragment::nothing ? fragment.z : std::numeric_limits<double>::quiet_NaN());
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file);
}

}  // namespace
}  // namespace mssim

int main(int count, char** arguments) try {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  mssim::PictureOptions options;
  options.view = mssim::view_direction(given.at(1)).value();
  options.width = static_cast<std::uint32_t>(std::stoul(given.at(2)));
  options.height = static_cast<std::uint32_t>(std::stoul(given.at(3)));
  const mssim::TraceReader trace(given.at(0));
  mssim::write_depths(mssim::last_surface(trace), mssim::shot_of(trace, options), given.at(4));
  return 0;
} catch (const std::exception& error) {
  std::cerr << "depth_map: " << error.what() << '\n';
  return 1;
}
