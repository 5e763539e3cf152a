#include "output/traces/h5md_body.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "hdf5/hdf5.h"
#include "output/traces/xdmf.h"

namespace mssim {

void require_fitting_body(const Topology& topology, const Surface& body) {
  if (body.points.empty() && body.triangles.empty()) return;
  if (!std::holds_alternative<Garment>(topology))
    throw std::invalid_argument("only a garment's trace has a body that does not move");
  const bool fits = std::ranges::all_of(body.triangles, [&](const auto& corners) {
    return std::ranges::all_of(corners, [&](std::uint32_t corner) { return corner < body.points.size(); });
  });
  if (body.triangles.empty() || !fits)
    throw std::invalid_argument("a trace's body needs triangles between its points");
}

void write_static_body(hid_t file, const Surface& body) {
  if (body.triangles.empty()) return;
  create_group(file, "/body");
  std::vector<std::array<float, 3>> points;
  points.reserve(body.points.size());
  for (const Vec3d& point : body.points)
    points.push_back({static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)});
  write_array(file, body_points_dataset, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT,
              std::array<hsize_t, 2>{points.size(), 3}, points.data());
  write_array(file, body_triangles_dataset, H5T_STD_U32LE, H5T_NATIVE_UINT32,
              std::array<hsize_t, 2>{body.triangles.size(), 3}, body.triangles.data());
}

}  // namespace mssim
