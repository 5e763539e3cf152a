#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/geometry.h"
#include "geometry/surface.h"

namespace mssim {

/// A closed line in which a surface meets a horizontal plane.
struct SectionLoop {
  std::vector<PlanPoint> points;         ///< m, in their order
  std::vector<std::uint32_t> triangles;  ///< in which it runs, from each point to the next
  double area = 0;                       ///< m^2, what it encloses, whichever way it runs

  PlanPoint low, high;  ///< corners of the box around it
};

/// The loops of a closed surface (validate_surface) at the height y, m, each once. `triangles` are all that
/// may reach the plane. A point in the plane counts as above it, so that loops close whatever lies in it.
std::vector<SectionLoop> section_loops(const Surface& surface, std::span<const std::uint32_t> triangles,
                                       double y);

/// The loop through these points, with area and box.
SectionLoop loop_of(std::vector<PlanPoint> points, std::vector<std::uint32_t> triangles);

/// Do the areas within two loops have a point in common?
bool overlap(const SectionLoop& a, const SectionLoop& b);

/// Cuts off what is joined to a loop by a narrow neck, as a hand is that rests against a hip: by a chord of
/// at most 0.6 of the outline that it cuts off, with at most a quarter of the area, all on one side of x = 0.
/// The narrowest necks go first. What remains of the loop stands at the front. Halves of a trunk above the
/// crotch are no such parts, being of a size, nor are bulges, which have no neck.
std::vector<SectionLoop> cut_at_necks(SectionLoop loop);

}  // namespace mssim
