#include "geometry/surface.h"

#include <algorithm>
#include <span>
#include <string>

#include "geometry/geometry.h"
#include "geometry/openings.h"
#include "geometry/surface_sides.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

class Check {
 public:
  Check(const Surface& surface, std::string_view name) : surface_(surface), name_(name) {}

  void all() const {
    if (surface_.triangles.empty()) fail("it has no triangles; give a closed surface");
    points();
    triangles();
    sides();
    if (!(volume_of(surface_) > 0))
      fail("it encloses a volume of " + shown(volume_of(surface_)) +
           " m^3; turn its triangles round so that they run counter-clockwise seen from outside");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(std::string(name_) + ": " + what);
  }

  /// Files number points and triangles in their own ways, so messages give coordinates.
  std::string at(std::uint32_t point) const { return place(surface_.points[point]); }
  std::string corners(std::size_t triangle) const {
    const auto& [a, b, c] = surface_.triangles[triangle];
    return "the triangle " + at(a) + ", " + at(b) + ", " + at(c);
  }

  void points() const {
    for (std::size_t p = 0; p < surface_.points.size(); ++p)
      if (!is_finite(surface_.points[p]))
        fail("point " + std::to_string(p) + " (from 0) has the coordinates " + place(surface_.points[p]) +
             "; give finite numbers");
  }

  void triangles() const {
    std::vector<bool> used(surface_.points.size());
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto& triangle = surface_.triangles[t];
      for (const std::uint32_t point : triangle) {
        if (point >= surface_.points.size())
          fail("triangle " + std::to_string(t) + " (from 0) names point " + std::to_string(point) +
               " but there are only " + pluralize(surface_.points.size(), "point") + ", counted from 0");
        used[point] = true;
      }
      const Vec3d& a = surface_.points[triangle[0]];
      const Vec3d ab = surface_.points[triangle[1]] - a;
      const Vec3d ac = surface_.points[triangle[2]] - a;
      if (length(cross(ab, ac)) <= flat * std::max(dot(ab, ab), dot(ac, ac)))
        fail(corners(t) + " has no area; remove it or move its points apart");
    }
    const auto unused = std::find(used.begin(), used.end(), false);
    if (unused != used.end())
      fail("the point " + at(static_cast<std::uint32_t>(unused - used.begin())) +
           " belongs to no triangle; remove it");
  }

  void sides() const {
    try {
      require_joined(surface_);
    } catch (const InputError& error) {
      fail(error.what());
    }
    const std::vector<SurfaceSide> sides = sides_by_edge(surface_);
    for (std::size_t first = 0; first < sides.size();) {
      const std::span<const SurfaceSide> of_edge = sides_of_edge(sides, first);
      const SurfaceSide& side = of_edge.front();
      const auto edge = [&] { return "the edge from " + at(side.low) + " to " + at(side.high); };
      if (of_edge.size() == 1) fail(edge() + " belongs to one triangle only; close the hole there");
      if (of_edge.size() > 2)
        fail(edge() + " belongs to " + std::to_string(of_edge.size()) +
             " triangles; an edge of a closed surface joins two, so separate the parts that meet there");
      if (side.upwards == of_edge.back().upwards)
        fail(corners(side.triangle) + " and " + corners(of_edge.back().triangle) + " both run along " +
             edge() + " in the same direction; turn one of them round");
      first += of_edge.size();
    }
  }

  /// Twice the area over the square of a side below which a triangle counts as a line.
  static constexpr double flat = 1e-9;

  const Surface& surface_;
  std::string_view name_;
};

}  // namespace

void validate_surface(const Surface& surface, std::string_view name) { Check(surface, name).all(); }

double volume_of(const Surface& surface) {
  if (surface.points.empty()) return 0;
  // Measured from a point of the surface rather than the origin, so that a body far away loses no digits.
  const Vec3d& apex = surface.points.front();
  double six_times = 0;
  for (const auto& [a, b, c] : surface.triangles)
    six_times += six_volumes(apex, surface.points[a], surface.points[b], surface.points[c]);
  return six_times / 6;
}

}  // namespace mssim
