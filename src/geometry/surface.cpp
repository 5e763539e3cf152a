#include "geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "geometry/geometry.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// One side of a triangle, in the triangle's orientation.
struct SurfaceSide {
  std::uint32_t low = 0, high = 0;  ///< its points
  bool upwards = false;             ///< from low to high
  std::size_t triangle = 0;

  std::uint32_t from() const { return upwards ? low : high; }
  std::uint32_t to() const { return upwards ? high : low; }
};

/// The sides of all triangles, grouped by edge, in the order of their triangles.
std::vector<SurfaceSide> sides_by_edge(const Surface& surface) {
  std::vector<SurfaceSide> sides;
  sides.reserve(3 * surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = surface.triangles[t][corner];
      const std::uint32_t to = surface.triangles[t][(corner + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), from < to, t});
    }
  std::ranges::sort(sides, {},
                    [](const SurfaceSide& side) { return std::tuple(side.low, side.high, side.triangle); });
  return sides;
}

/// The sides of the edge that begins at `first`.
std::span<const SurfaceSide> sides_of_edge(std::span<const SurfaceSide> sides, std::size_t first) {
  std::size_t end = first + 1;
  while (end < sides.size() && sides[end].low == sides[first].low && sides[end].high == sides[first].high)
    ++end;
  return sides.subspan(first, end - first);
}

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
           " m^3; reverse its triangles so that they are counter-clockwise seen from outside");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError("{}: {}", name_, what); }

  /// Files number points and triangles in different ways, so messages give coordinates.
  std::string at(std::uint32_t point) const { return place(surface_.points[point]); }
  std::string corners(std::size_t triangle) const {
    const auto& [a, b, c] = surface_.triangles[triangle];
    return fmt::format("the triangle {}, {}, {}", at(a), at(b), at(c));
  }

  void points() const {
    for (std::size_t p = 0; p < surface_.points.size(); ++p)
      if (!is_finite(surface_.points[p]))
        fail(fmt::format("point {} (from 0) has the coordinates {}; give finite numbers", p,
                         place(surface_.points[p])));
  }

  void triangles() const {
    std::vector<bool> used(surface_.points.size());
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto& triangle = surface_.triangles[t];
      for (const std::uint32_t point : triangle) {
        if (point >= surface_.points.size())
          fail(fmt::format("triangle {} (from 0) names point {} but there are only {}, counted from 0", t,
                           point, pluralize(surface_.points.size(), "point")));
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
      fail(fmt::format("the point {} belongs to no triangle; remove it",
                       at(static_cast<std::uint32_t>(unused - used.begin()))));
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
      const auto edge = [&] { return fmt::format("the edge from {} to {}", at(side.low), at(side.high)); };
      if (of_edge.size() == 1) fail(edge() + " belongs to one triangle only; close the hole there");
      if (of_edge.size() > 2)
        fail(edge() + " belongs to " + std::to_string(of_edge.size()) +
             " triangles; an edge of a closed surface joins two, so separate the parts that meet there");
      if (side.upwards == of_edge.back().upwards)
        fail(fmt::format("{} and {} both run along {} in the same direction; turn one of them round",
                         corners(side.triangle), corners(of_edge.back().triangle), edge()));
      first += of_edge.size();
    }
  }

  /// Twice the area over the square of a side; a triangle below this counts as a line.
  static constexpr double flat = 1e-9;

  const Surface& surface_;
  std::string_view name_;
};

constexpr std::uint32_t unknown = UINT32_MAX;

/// The edges of one triangle only, in that triangle's orientation, by their first points.
class FreeEdges {
 public:
  explicit FreeEdges(const Surface& surface) : ends_(surface.points.size()) {
    const std::vector<SurfaceSide> sides = sides_by_edge(surface);
    for (std::size_t first = 0; first < sides.size();) {
      const auto of_edge = sides_of_edge(sides, first);
      const bool has_length = of_edge.front().low != of_edge.front().high;
      if (of_edge.size() == 1 && has_length) ends_[of_edge.front().from()].push_back(of_edge.front().to());
      first += of_edge.size();
    }
  }

  std::size_t count() const {
    std::size_t sum = 0;
    for (const auto& ends : ends_) sum += ends.size();
    return sum;
  }
  /// Is the point the first or last point of such an edge?
  std::vector<bool> touched() const {
    std::vector<bool> is_touched(ends_.size());
    for (std::size_t from = 0; from < ends_.size(); ++from)
      for (const std::uint32_t to : ends_[from]) is_touched[from] = is_touched[to] = true;
    return is_touched;
  }
  bool any_from(std::uint32_t point) const { return !ends_[point].empty(); }
  /// Removes one of the edges that begin at a point and returns its end.
  std::uint32_t take_from(std::uint32_t point) {
    const std::uint32_t end = ends_[point].back();
    ends_[point].pop_back();
    return end;
  }

 private:
  std::vector<std::vector<std::uint32_t>> ends_;
};

/// Merges points within a distance of each other, each with the nearest earlier one.
class Joiner {
 public:
  Joiner(Surface& surface, double reach)
      : surface_(surface), reach_(reach), into_(surface.points.size()), triangles_(surface.points.size()) {
    std::iota(into_.begin(), into_.end(), 0U);
    const std::vector<bool> is_open = FreeEdges(surface).touched();
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (const std::uint32_t corner : surface.triangles[t])
        if (is_open[corner]) triangles_[corner].push_back(t);
    for (std::uint32_t point = 0; point < is_open.size(); ++point)
      if (is_open[point]) place(point);
  }

  /// Removes the merged points from the surface; returns their number.
  std::size_t finish() {
    std::vector<std::uint32_t> number(into_.size());
    std::uint32_t kept = 0;
    for (std::uint32_t point = 0; point < into_.size(); ++point)
      if (into_[point] == point) {
        number[point] = kept;
        surface_.points[kept++] = surface_.points[point];
      }
    for (auto& triangle : surface_.triangles)
      for (std::uint32_t& corner : triangle) corner = number[into_[corner]];
    surface_.points.resize(kept);
    return into_.size() - kept;
  }

 private:
  using Cell = std::array<double, 3>;

  void place(std::uint32_t point) {
    const Vec3d& at = surface_.points[point];
    const Cell cell{std::floor(at.x / reach_), std::floor(at.y / reach_), std::floor(at.z / reach_)};
    double nearest = reach_;
    for (const double x : {-1, 0, 1})
      for (const double y : {-1, 0, 1})
        for (const double z : {-1, 0, 1}) {
          const auto others = kept_.find({cell[0] + x, cell[1] + y, cell[2] + z});
          if (others == kept_.end()) continue;
          for (const std::uint32_t other : others->second)
            if (const double distance = length(surface_.points[other] - at);
                distance <= nearest && !share_a_triangle(point, other)) {
              nearest = distance;
              into_[point] = other;
            }
        }
    if (into_[point] == point) kept_[cell].push_back(point);
  }

  /// Includes points that have been merged into the other and the point.
  bool share_a_triangle(std::uint32_t point, std::uint32_t other) const {
    return std::ranges::any_of(triangles_[point], [&](std::size_t t) {
      return std::ranges::any_of(surface_.triangles[t], [&](std::uint32_t corner) {
        return corner != point && into_[corner] == other;
      });
    });
  }

  Surface& surface_;
  double reach_;
  std::vector<std::uint32_t> into_;
  std::vector<std::vector<std::size_t>> triangles_;  ///< of the points on open edges
  std::map<Cell, std::vector<std::uint32_t>> kept_;
};

void measure(const Surface& surface, Opening& opening) {
  Vec3d sum;
  double total = 0;
  for (std::size_t i = 0; i < opening.edges(); ++i) {
    const Vec3d& from = surface.points[opening.points[i]];
    const Vec3d& to = surface.points[opening.points[(i + 1) % opening.points.size()]];
    const double weight = length(to - from);
    sum += 0.5 * weight * (from + to);
    total += weight;
  }
  // Two numbers for one location make edges of length zero.
  opening.centre = total > 0 ? 1 / total * sum : surface.points[opening.points.front()];
  const std::vector<std::uint32_t>& points = opening.points;
  constexpr std::size_t most_pairwise = 3000;  // beyond: twice the distance from the centre, which is no less
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points.size() > most_pairwise)
      opening.size = std::max(opening.size, 2 * length(surface.points[points[i]] - opening.centre));
    else
      for (std::size_t j = 0; j < i; ++j)
        opening.size = std::max(opening.size, length(surface.points[points[i]] - surface.points[points[j]]));
}

void fill(Surface& surface, const Opening& opening) {
  const std::vector<std::uint32_t>& ring = opening.points;
  if (ring.size() == 3) {
    surface.triangles.push_back({ring[2], ring[1], ring[0]});
    return;
  }
  const auto middle = static_cast<std::uint32_t>(surface.points.size());
  surface.points.push_back(opening.centre);
  for (std::size_t i = 0; i < ring.size(); ++i)
    surface.triangles.push_back({ring[(i + 1) % ring.size()], ring[i], middle});
}

/// Edges between two points, the lower number first.
using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Like `fill`, but without a middle point as long as a corner of the ring can be cut off: if the surface
/// does not yet have that edge, and the triangle faces the same way as the opening.
void span(Surface& surface, Opening opening, Edges& edges) {
  std::vector<std::uint32_t>& ring = opening.points;
  const auto point = [&](std::size_t i) { return ring[i % ring.size()]; };
  const auto at = [&](std::size_t i) -> const Vec3d& { return surface.points[point(i)]; };
  const auto normal = [&](const Vec3d& middle, std::size_t i) {
    return cross(at(i + 1) - middle, at(i) - middle);
  };
  Vec3d facing;
  for (std::size_t i = 0; i < ring.size(); ++i) facing += normal(opening.centre, i);
  while (ring.size() > 3) {
    std::size_t first = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const double new_edge = length(at(i + 2) - at(i));
      if (new_edge >= shortest || !(dot(normal(at(i + 2), i), facing) > 0)) continue;
      if (edges.contains(std::minmax(ring[i], point(i + 2)))) continue;
      shortest = new_edge;
      first = i;
    }
    if (shortest == std::numeric_limits<double>::infinity()) break;
    surface.triangles.push_back({point(first + 2), point(first + 1), ring[first]});
    edges.insert(std::minmax(ring[first], point(first + 2)));
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>((first + 1) % ring.size()));
  }
  measure(surface, opening);
  fill(surface, opening);
}

[[noreturn]] void refuse(const Opening& opening, const std::string& problem) {
  const auto millimetres = [](double metres) { return std::round(metres * 1000) / 1000 + 0.0; };  // never -0
  const Vec3d& centre = opening.centre;
  throw InputError("the opening of {} edges around ({}, {}, {}){}", opening.edges(), millimetres(centre.x),
                   millimetres(centre.y), millimetres(centre.z), problem);
}

}  // namespace

void validate_surface(const Surface& surface, std::string_view name) { Check(surface, name).all(); }

double volume_of(const Surface& surface) {
  if (surface.points.empty()) return 0;
  // Relative to a point of the surface instead of the origin, so a distant body loses no digits.
  const Vec3d& apex = surface.points.front();
  double six_times = 0;
  for (const auto& [a, b, c] : surface.triangles)
    six_times += six_volumes(apex, surface.points[a], surface.points[b], surface.points[c]);
  return six_times / 6;
}

std::vector<Surface> closed_parts(const Surface& surface) {
  DisjointSets joined(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles)
    for (const std::uint32_t other : {b, c}) joined.unite(a, other);
  std::vector<Surface> parts;
  std::vector<std::uint32_t> part_of(surface.points.size(), unknown);
  for (const auto& triangle : surface.triangles) {
    std::uint32_t& part = part_of[joined.root(triangle[0])];
    if (part == unknown) {
      part = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[part].triangles.push_back(triangle);
  }
  std::vector<std::uint32_t> number(surface.points.size(), unknown);
  for (std::uint32_t point = 0; point < surface.points.size(); ++point) {
    const std::uint32_t part = part_of[joined.root(point)];
    if (part == unknown) continue;  // no triangle has it
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

std::vector<Opening> openings_of(const Surface& surface) {
  FreeEdges edges(surface);
  std::vector<Opening> openings;
  constexpr std::size_t nowhere = SIZE_MAX;
  std::vector<std::size_t> place_on_way(surface.points.size(), nowhere);
  for (std::uint32_t start = 0; start < surface.points.size(); ++start)
    while (edges.any_from(start)) {
      std::vector<std::uint32_t> way{start};
      place_on_way[start] = 0;
      do {
        const std::uint32_t next = edges.take_from(way.back());
        const std::size_t begin = place_on_way[next];
        if (begin == nowhere) {
          place_on_way[next] = way.size();
          way.push_back(next);
          continue;
        }
        Opening& ring = openings.emplace_back();
        ring.points.assign(way.begin() + static_cast<std::ptrdiff_t>(begin), way.end());
        for (std::size_t i = begin + 1; i < way.size(); ++i) place_on_way[way[i]] = nowhere;
        way.resize(begin + 1);
      } while (edges.any_from(way.back()));
      for (const std::uint32_t point : way) place_on_way[point] = nowhere;
      if (way.size() > 1) openings.push_back({std::move(way), false, {}, 0});
    }
  for (Opening& opening : openings) measure(surface, opening);
  std::ranges::stable_sort(openings, std::greater(), &Opening::size);
  return openings;
}

std::size_t join_corners(Surface& surface) {
  const Vec3d size = box_of(surface.points).size();
  const double extent = std::max({size.x, size.y, size.z});
  std::size_t merged = 0;
  // On a thin sheet, matching corners are found before the distance reaches the other side.
  if (extent > 0)
    for (const double share : {1e-7, 1e-6, 1e-5}) merged += Joiner(surface, share * extent).finish();
  return merged;
}

void require_joined(const Surface& surface) {
  const std::size_t free = FreeEdges(surface).count();
  const std::size_t edges = (3 * surface.triangles.size() + free) / 2;
  if (surface.triangles.size() > 1 && 2 * free > edges)
    throw InputError(
        "its triangles do not join: {} of {} edges belong to one triangle only; merge the points of corners "
        "that lie next to each other where the surface was made",
        free, edges);
}

std::vector<Opening> close_openings(Surface& surface, double largest) {
  require_joined(surface);
  std::vector<Opening> openings = openings_of(surface);
  for (const Opening& opening : openings) {
    if (!(opening.size <= largest))
      refuse(opening, " is " + shown(std::ceil(opening.size * 1000) / 1000) + " m across, and at most " +
                          shown(largest) + " m are closed; close it where the surface was made");
    if (!opening.is_ring)
      refuse(opening,
             " does not enclose a hole, because adjacent triangles have different orientations; give them "
             "one orientation where the surface was made");
  }
  for (const Opening& opening : openings) fill(surface, opening);
  return openings;
}

void span_openings(Surface& surface) {
  const std::vector<Opening> openings = openings_of(surface);
  std::vector<bool> on_ring(surface.points.size());
  for (const Opening& opening : openings)
    for (const std::uint32_t point : opening.points) on_ring[point] = true;
  Edges edges;
  for (const SurfaceSide& side : sides_by_edge(surface))
    if (on_ring[side.low] && on_ring[side.high]) edges.emplace(side.low, side.high);
  for (const Opening& opening : openings) span(surface, opening, edges);
}

std::vector<Vec3d> vertex_normals(const Surface& surface) {
  std::vector<Vec3d> normals(surface.points.size());
  for (const auto& triangle : surface.triangles)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3d& at = surface.points[triangle[corner]];
      const Vec3d to_next = surface.points[triangle[(corner + 1) % 3]] - at;
      const Vec3d to_last = surface.points[triangle[(corner + 2) % 3]] - at;
      const Vec3d normal = cross(to_next, to_last);
      const double sine = length(normal);  // both are times both lengths
      if (sine > 0) normals[triangle[corner]] += (std::atan2(sine, dot(to_next, to_last)) / sine) * normal;
    }
  for (Vec3d& normal : normals)
    if (const double sum = length(normal); sum > 0) normal = (1 / sum) * normal;
  return normals;
}

Surface inflated(const Surface& surface, const std::vector<Vec3d>& normals, double offset) {
  Surface result = surface;
  for (std::size_t point = 0; point < result.points.size(); ++point)
    result.points[point] += offset * normals[point];
  return result;
}

}  // namespace mssim
