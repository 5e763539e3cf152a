#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "geometry/surface.h"

namespace mssim {

/// Adds points to a surface, each place once: files that list every triangle's corners apart become surfaces
/// whose triangles share them.
class PointMerger {
 public:
  explicit PointMerger(Surface& surface) : surface_(surface) {}

  /// The number of the point at this place, exactly this one.
  std::uint32_t add(const Vec3d& point) {
    // Adding zero turns -0 into 0.
    const std::array<double, 3> key{point.x + 0.0, point.y + 0.0, point.z + 0.0};
    const auto [entry, is_new] = number_.try_emplace(key, static_cast<std::uint32_t>(surface_.points.size()));
    if (is_new) surface_.points.push_back({key[0], key[1], key[2]});
    return entry->second;
  }

 private:
  Surface& surface_;
  std::map<std::array<double, 3>, std::uint32_t> number_;
};

}  // namespace mssim
