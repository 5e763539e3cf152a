#include "surface_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "fuzz_checks.h"
#include "garment/body/stance.h"
#include "geometry/surface.h"
#include "mesh/surface_file.h"
#include "tests/support/obj_text.h"
#include "text/error.h"

namespace mssim {

void check_surface(const Surface& surface) {
  require(!surface.triangles.empty(), "a surface has triangles");
  std::vector<bool> used(surface.points.size());
  for (const auto& triangle : surface.triangles)
    for (const std::uint32_t point : triangle) {
      require(point < surface.points.size(), "corners are points");
      used[point] = true;
    }
  require(std::find(used.begin(), used.end(), false) == used.end(), "points are corners");
  std::vector<std::tuple<double, double, double>> places;
  for (const Vec3d& point : surface.points) {
    require(is_finite(point), "points are finite");
    places.emplace_back(point.x, point.y, point.z);
  }
  std::sort(places.begin(), places.end());
  require(std::adjacent_find(places.begin(), places.end()) == places.end(), "points stand apart");

  const Surface again = parse_obj("again.obj", obj_text(surface, 17));
  const auto corner = [](const Surface& of, std::size_t t, std::size_t i) {
    return of.points[of.triangles[t][i]];
  };
  require(again.points.size() == surface.points.size() && again.triangles.size() == surface.triangles.size(),
          "written surfaces read back");
  // Points are numbered as triangles name them, and those of a polygon as it does.
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      require(corner(again, t, i) == corner(surface, t, i), "written surfaces read back");

  Surface joined = surface;
  const std::size_t merged = join_corners(joined);
  require(joined.points.size() + merged == surface.points.size(), "points that are merged go");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto same = [&](const Surface& of) { return of.triangles[t][i] == of.triangles[t][(i + 1) % 3]; };
      require(same(joined) == same(surface), "corners of one triangle stay apart");
    }

  unless_refused<InputError>([&] { return guess_stance(surface, {}); });
  const std::size_t openings = openings_of(surface).size();
  unless_refused<InputError>([&] {
    Surface filled = surface;
    require(close_openings(filled, HUGE_VAL).size() == openings, "all openings are closed");
    require(openings_of(filled).empty(), "no closed opening leaves another");
    return true;
  });

  const auto closed = unless_refused<InputError>([&] {
    validate_surface(surface, "surface");
    return true;
  });
  if (!closed) return;
  require(openings == 0, "a closed surface has no openings");
  require(surface.triangles.size() % 2 == 0, "a closed surface has three edges for two triangles");
  require(std::isfinite(volume_of(surface)) && volume_of(surface) > 0, "a closed surface has a volume");
}

}  // namespace mssim
