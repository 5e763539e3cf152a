#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

/// A curve in the plane of a pattern (z = 0; m): a polyline, whose points are found by their arc length.
class Curve {
 public:
  /// Chords of one Bezier segment. One that turns by a right angle comes out shorter by 6e-6 of its length.
  static constexpr std::size_t chords = 128;

  /// Throws InputError unless there are two points or more, all finite, with z = 0, each apart from the next.
  explicit Curve(std::vector<Vec3d> points);

  /// A chain of cubic Bezier segments: end point, two control points, end point, two control points, ..., end
  /// point, as a polyline of `chords` chords each. Throws InputError unless there are 3 n + 1 points with n >
  /// 0.
  static Curve bezier(std::span<const Vec3d> points);

  /// m
  double length() const { return arcs_.back(); }
  const Vec3d& first() const { return points_.front(); }
  const Vec3d& last() const { return points_.back(); }
  const std::vector<Vec3d>& points() const { return points_; }

  /// The point at this fraction of the arc length; exactly the ends for 0 and 1, and for what lies beyond.
  Vec3d at(double fraction) const;

  /// Cut in two at this fraction of the arc length, which lies between 0 and 1, both excluded.
  std::pair<Curve, Curve> split(double fraction) const;

  /// This curve and then that one, which begins where this one ends.
  Curve followed_by(const Curve& next) const;

  /// The curve with x negated: a left panel's boundary becomes a right one's.
  Curve mirrored() const;

 private:
  /// The first point beyond `arc`, counted so that it has a point before it.
  std::size_t point_after(double arc) const;

  std::vector<Vec3d> points_;
  std::vector<double> arcs_;  ///< m, from the first point to each
};

}  // namespace mssim
