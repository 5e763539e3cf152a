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

/// A range of heights, m.
struct HeightRange {
  double low = 0, high = 0;

  bool contains(double y) const { return y >= low && y <= high; }
};

/// The triangles of a surface, sorted into horizontal slices of equal height.
class HeightSlices {
 public:
  explicit HeightSlices(const Surface& surface);

  double lowest() const { return lowest_; }    ///< y, m
  double highest() const { return highest_; }  ///< y, m
  /// The triangles that reach into the slice at the height y, in their order; y is within the surface.
  std::span<const std::uint32_t> at(double y) const { return slices_[slice_of(y)]; }

 private:
  std::size_t slice_of(double y) const;

  double lowest_ = 0, highest_ = 0;
  std::vector<std::vector<std::uint32_t>> slices_;
};

/// The part of a body for which garments are measured and with which they collide.
struct TrunkAndLegs {
  Surface surface;                      ///< closed
  std::optional<HeightRange> left_out;  ///< heights of other parts of the body
  /// Heights at which such a part touches trunk or leg, for example a hand the hip. It is cut off at its
  /// narrowest point there, or counts as trunk or leg from there down.
  std::optional<HeightRange> touched;
};

/// A standing body (BodyProfile) without arms, hands, hair and objects next to it: trunk, legs, and the parts
/// above them. The closed loops of many horizontal sections distinguish the parts; loops that overlap or
/// contain each other form one group. The search starts from the largest group that reaches x = 0 half way up
/// the trunk, and adds groups that overlap it at the next height. Downwards, it excludes groups much smaller
/// than the rest (an arm next to the trunk, fingers next to a thigh); upwards, groups that join the trunk
/// again further up. A hand that hangs from an arm and touches the hip is cut off at its neck (cut_at_necks).
/// The result omits whole triangles, with a rim where parts touch, and closes the openings. A surface without
/// other parts, or that does not reach x = 0, is returned unchanged.
///
/// `surface` is closed (validate_surface).
TrunkAndLegs trunk_and_legs(const Surface& surface);

/// A note about the parts of the body that garments ignore, and the heights where that is uncertain. Empty if
/// there are none.
std::string ignored_parts(const TrunkAndLegs& body);

/// A closed line in which a surface intersects a horizontal plane.
struct SectionLoop {
  std::vector<PlanPoint> points;         ///< m, in order
  std::vector<std::uint32_t> triangles;  ///< with the line from each point to the next
  double area = 0;                       ///< m^2, enclosed, not negative

  PlanPoint low, high;  ///< corners of the box around it
};

/// The loops of a closed surface (validate_surface) at the height y, m. `triangles` includes all that may
/// reach the plane. A point in the plane counts as above it, so that all loops close.
std::vector<SectionLoop> section_loops(const Surface& surface, std::span<const std::uint32_t> triangles,
                                       double y);

/// The loop through these points, with area and box.
SectionLoop loop_of(std::vector<PlanPoint> points, std::vector<std::uint32_t> triangles);

/// Whether the areas within two loops have a common point.
bool overlap(const SectionLoop& a, const SectionLoop& b);

/// Cuts off parts that a narrow neck joins to a loop, for example a hand that touches a hip. The chord is at
/// most 0.6 of the outline that it cuts off; the part has at most a quarter of the area and is on one side of
/// x = 0. The narrowest necks are cut first. The first loop of the result is the rest. Halves of a trunk
/// above the crotch stay, because their areas are about equal, and bulges, because they have no neck.
std::vector<SectionLoop> cut_at_necks(SectionLoop loop);

}  // namespace mssim
