// Writes the depths that mssim's rasteriser finds in the last frame of a trace, for vtk_test.sh:
//   depth_map TRACE AZIMUTH,ELEVATION WIDTH HEIGHT FILE
// FILE gets a double for each point that `mssim render` draws such a picture at, row by row from the lowest:
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

namespace {

using namespace mssim;

/// What a picture of the last frame shows.
Surface last_surface(const TraceReader& trace) {
  const TraceContent& content = trace.content();
  const std::vector<Vec3d> position = trace.positions(trace.frames() - 1);
  const Skin skin = skin_of(content.shape, trace.positions(0));
  Surface surface{{}, skin.triangles};
  for (const std::uint32_t node : skin.node) surface.points.push_back(position[node]);
  const auto first = static_cast<std::uint32_t>(surface.points.size());
  for (const Vec3d& point : content.body.points) surface.points.push_back(point);
  for (const auto& [a, b, c] : content.body.triangles)
    surface.triangles.push_back({first + a, first + b, first + c});
  return surface;
}

void write_depths(Surface surface, Shot shot, const std::string& file) {
  const Camera camera(shot.direction);
  shot.seen = seen_box(camera, surface.points);
  for (Vec3d& point : surface.points) point = camera.seen(point);
  std::ofstream out(file, std::ios::binary);
  for (const Fragment& fragment : rasterise(surface, drawn_points(shot), ViewFrom::front)) {
    const bool hit = fragment.triangle != Fragment::nothing;
    const double depth = hit ? fragment.z : std::numeric_limits<double>::quiet_NaN();
    out.write(reinterpret_cast<const char*>(&depth), sizeof depth);
  }
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file);
}

}  // namespace

int main(int count, char** arguments) try {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  Shot shot;
  shot.direction = view_direction(given.at(1)).value();
  shot.width = static_cast<std::uint32_t>(std::stoul(given.at(2)));
  shot.height = static_cast<std::uint32_t>(std::stoul(given.at(3)));
  write_depths(last_surface(TraceReader(given.at(0))), shot, given.at(4));
  return 0;
} catch (const std::exception& error) {
  std::cerr << "depth_map: " << error.what() << '\n';
  return 1;
}
