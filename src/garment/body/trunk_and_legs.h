#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/geometry.h"
#include "geometry/surface.h"

namespace mssim {

/// Heights from one to another, m.
struct HeightRange {
  double low = 0, high = 0;
};

/// The triangles of a surface by horizontal slices of equal height.
class HeightSlices {
 public:
  explicit HeightSlices(const Surface& surface);

  double lowest() const { return lowest_; }    ///< y, m
  double highest() const { return highest_; }  ///< y, m
  /// Those that reach into the slice at the height y, which the surface has; in their order.
  std::span<const std::uint32_t> at(double y) const { return slices_[slice_of(y)]; }

 private:
  std::size_t slice_of(double y) const;

  double lowest_ = 0, highest_ = 0;
  std::vector<std::vector<std::uint32_t>> slices_;
};

/// What of a body garments are measured for and meet.
struct TrunkAndLegs {
  Surface surface;                      ///< closed
  std::optional<HeightRange> left_out;  ///< where the body has other parts
  /// Where such a part touches trunk or leg (a hand the hip, say): it is cut off there at its narrowest, or
  /// counts as trunk or leg from there down.
  std::optional<HeightRange> touched;
};

/// A standing body (BodyProfile) without arms, hands, hair and what stands beside it: its trunk, its legs,
/// and what grows upwards out of them. The closed loops of many horizontal sections tell them apart. Loops
/// that overlap, or lie within each other, are one. From the largest that reaches x = 0 half way up the
/// body's trunk on, what overlaps it at the next height belongs to it, too: downwards but for what is much
/// smaller than the rest (an arm beside the trunk, fingers beside a thigh), upwards but for what is joined
/// with the trunk again further up. A hand that rests against the hip is cut off at its neck
/// (cut_at_necks) where it hangs from an arm. Left out are whole triangles, with a rim where
/// parts touch, and where that opens the surface it is closed. A surface without other parts, and one that
/// reaches x = 0 nowhere, is given back as it is.
///
/// `surface` is closed (validate_surface).
TrunkAndLegs trunk_and_legs(const Surface& surface);

/// What a reader should know of it: which parts of the body garments ignore, and where that is not certain.
/// Empty where there are none.
std::string ignored_parts(const TrunkAndLegs& body);

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
