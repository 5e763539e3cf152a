#include "garment/pattern/curve.h"

#include <algorithm>
#include <string>

#include "geometry/geometry.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

Curve::Curve(std::vector<Vec3d> points) : points_(std::move(points)) {
  if (points_.size() < 2)
    throw InputError("a boundary curve has " + pluralize(points_.size(), "point") +
                     "; give two or more points");
  arcs_.reserve(points_.size());
  const auto point = [this](std::size_t i) {
    return "point " + std::to_string(i) + " of a boundary curve, " + place(points_[i]) + ",";
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!is_finite(points_[i]) || points_[i].z != 0)
      throw InputError(point(i) +
                       " does not lie in the plane of the pattern; give finite x and y, and z = 0");
    if (i > 0 && points_[i] == points_[i - 1])
      throw InputError(point(i) + " is the same as the one before it; leave one of them out");
    arcs_.push_back(i == 0 ? 0 : arcs_.back() + mssim::length(points_[i] - points_[i - 1]));
  }
}

Curve Curve::bezier(std::span<const Vec3d> points) {
  if (points.size() < 4 || points.size() % 3 != 1)
    throw InputError("a chain of cubic Bezier segments has " + pluralize(points.size(), "point") +
                     "; give 4, 7, 10 or another 3 n + 1 points");
  std::vector<Vec3d> polyline{points.front()};
  polyline.reserve(points.size() / 3 * chords + 1);
  for (std::size_t p = 0; p + 3 < points.size(); p += 3)
    for (std::size_t i = 1; i <= chords; ++i) {
      const double t = static_cast<double>(i) / chords, s = 1 - t;
      polyline.push_back((s * s * s) * points[p] + (3 * s * s * t) * points[p + 1] +
                         (3 * s * t * t) * points[p + 2] + (t * t * t) * points[p + 3]);
    }
  return Curve(std::move(polyline));
}

std::size_t Curve::point_after(double arc) const {
  const auto after = std::upper_bound(arcs_.begin() + 1, arcs_.end() - 1, arc);
  return static_cast<std::size_t>(after - arcs_.begin());
}

Vec3d Curve::at(double fraction) const {
  if (fraction <= 0) return first();
  if (fraction >= 1) return last();
  const double arc = fraction * length();
  const std::size_t i = point_after(arc);
  const double t = (arc - arcs_[i - 1]) / (arcs_[i] - arcs_[i - 1]);
  return points_[i - 1] + t * (points_[i] - points_[i - 1]);
}

std::pair<Curve, Curve> Curve::split(double fraction) const {
  if (!(fraction > 0 && fraction < 1))
    throw InputError("a boundary curve cannot be split at " + shown(fraction) +
                     " of its length; give a fraction between 0 and 1");
  const Vec3d cut = at(fraction);
  const auto after = points_.begin() + static_cast<std::ptrdiff_t>(point_after(fraction * length()));
  std::vector<Vec3d> before(points_.begin(), after), rest(after, points_.end());
  if (!(before.back() == cut)) before.push_back(cut);
  if (!(rest.front() == cut)) rest.insert(rest.begin(), cut);
  return {Curve(std::move(before)), Curve(std::move(rest))};
}

Curve Curve::followed_by(const Curve& next) const {
  std::vector<Vec3d> points = points_;
  points.insert(points.end(), next.points_.begin() + (next.first() == last() ? 1 : 0), next.points_.end());
  return Curve(std::move(points));
}

Curve Curve::mirrored() const {
  std::vector<Vec3d> points = points_;
  for (Vec3d& point : points) point.x = -point.x;
  return Curve(std::move(points));
}

}  // namespace mssim
