#include "geometry/closed_parts.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "geometry/disjoint_sets.h"

namespace mssim {
namespace {

constexpr std::uint32_t unknown = UINT32_MAX;

/// For each point, one point of the part that it belongs to, the same for the whole part.
std::vector<std::uint32_t> representatives(const Surface& surface) {
  DisjointSets parts(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles)
    for (const std::uint32_t other : {b, c}) parts.unite(a, other);
  std::vector<std::uint32_t> representative(surface.points.size());
  for (std::uint32_t point = 0; point < representative.size(); ++point)
    representative[point] = parts.root(point);
  return representative;
}

}  // namespace

std::vector<Surface> closed_parts(const Surface& surface) {
  const std::vector<std::uint32_t> representative = representatives(surface);
  std::vector<Surface> parts;
  std::vector<std::uint32_t> part_of(surface.points.size(), unknown);
  for (const auto& triangle : surface.triangles) {
    std::uint32_t& part = part_of[representative[triangle[0]]];
    if (part == unknown) {
      part = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[part].triangles.push_back(triangle);
  }
  std::vector<std::uint32_t> number(surface.points.size(), unknown);
  for (std::size_t point = 0; point < surface.points.size(); ++point) {
    const std::uint32_t part = part_of[representative[point]];
    if (part == unknown) continue;  // of no triangle
    number[point] = static_cast<std::uint32_t>(parts[part].points.size());
    parts[part].points.push_back(surface.points[point]);
  }
  for (Surface& part : parts) {
    for (auto& triangle : part.triangles)
      for (std::uint32_t& point : triangle) point = number[point];
    if (volume_of(part) < 0)
      for (auto& triangle : part.triangles) std::swap(triangle[1], triangle[2]);
  }
  return parts;
}

Surface facing_outwards(const Surface& surface) {
  Surface all;
  for (const Surface& part : closed_parts(surface)) {
    const auto offset = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    for (const auto& [a, b, c] : part.triangles)
      all.triangles.push_back({a + offset, b + offset, c + offset});
  }
  return all;
}

}  // namespace mssim
