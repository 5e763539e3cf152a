#include "geometry/openings.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "geometry/geometry.h"
#include "geometry/surface_sides.h"
#include "text/input_error.h"

namespace mssim {
namespace {

/// The edges that belong to one triangle only, as that triangle runs, by the point where they begin.
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

  bool any_from(std::uint32_t point) const { return !ends_[point].empty(); }
  /// The end of one of them, which is taken away.
  std::uint32_t take_from(std::uint32_t point) {
    const std::uint32_t end = ends_[point].back();
    ends_[point].pop_back();
    return end;
  }

 private:
  std::vector<std::vector<std::uint32_t>> ends_;
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
  // Points of two numbers at one place make edges without length.
  opening.centre = total > 0 ? 1 / total * sum : surface.points[opening.points.front()];
  for (const std::uint32_t point : opening.points)
    opening.size = std::max(opening.size, 2 * length(surface.points[point] - opening.centre));
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

/// As `fill` does, but without a middle as long as a corner of the ring may be cut off: where the surface has
/// no such edge yet, and the triangle looks the way the opening does.
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
  throw InputError("the opening of " + std::to_string(opening.edges()) + " edges around " +
                   place(opening.centre) + problem);
}

}  // namespace

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
  std::stable_sort(openings.begin(), openings.end(),
                   [](const Opening& a, const Opening& b) { return a.size > b.size; });
  return openings;
}

std::vector<Opening> close_openings(Surface& surface, double largest) {
  std::vector<Opening> openings = openings_of(surface);
  for (const Opening& opening : openings) {
    if (!(opening.size <= largest))
      refuse(opening, " is " + shown(opening.size) + " m across, and at most " + shown(largest) +
                          " m are closed; close it where the surface was made");
    if (!opening.is_ring)
      refuse(opening,
             " does not enclose a hole, because triangles beside it have different orientations; give them "
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

}  // namespace mssim
