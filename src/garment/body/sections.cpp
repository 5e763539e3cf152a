#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

#include "garment/body/trunk_and_legs.h"

namespace mssim {
namespace {

/// A triangle that the plane cuts, and its two cut edges.
struct CutTriangle {
  std::uint32_t triangle = 0;
  std::uint64_t in = 0, out = 0;  ///< names of the edges
  PlanPoint at;                   ///< intersection of the plane and edge `in`
  bool done = false;
};

std::uint64_t edge_name(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// The intersection of the plane and an edge from below it to above it.
PlanPoint crossing(const Vec3d& below, const Vec3d& above, double y) {
  const double fraction = (y - below.y) / (above.y - below.y);
  return {below.x + fraction * (above.x - below.x), below.z + fraction * (above.z - below.z)};
}

std::vector<CutTriangle> cut_triangles(const Surface& surface, std::span<const std::uint32_t> triangles,
                                       double y) {
  std::vector<CutTriangle> cuts;
  for (const std::uint32_t t : triangles) {
    const auto& corners = surface.triangles[t];
    CutTriangle cut{t, 0, 0, {}};
    bool is_cut = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
      const Vec3d &from = surface.points[a], &to = surface.points[b];
      if ((from.y < y) == (to.y < y)) continue;
      is_cut = true;
      if (from.y < y) {
        cut.in = edge_name(a, b);
        cut.at = crossing(from, to, y);
      } else {
        cut.out = edge_name(a, b);
      }
    }
    if (is_cut) cuts.push_back(cut);
  }
  return cuts;
}

double cross(const PlanPoint& a, const PlanPoint& b) { return a.x * b.z - a.z * b.x; }

double twice_area(const std::vector<PlanPoint>& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) sum += cross(points[i], points[(i + 1) % points.size()]);
  return sum;
}

bool contains(const SectionLoop& loop, const PlanPoint& point) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const PlanPoint &a = loop.points[i], &b = loop.points[(i + 1) % loop.points.size()];
    if ((a.z > point.z) != (b.z > point.z) && point.x < a.x + (point.z - a.z) / (b.z - a.z) * (b.x - a.x))
      inside = !inside;
  }
  return inside;
}

using Side = std::pair<PlanPoint, PlanPoint>;

bool cross_each_other(const Side& a, const Side& b) {
  return (side_of(a.first, a.second, b.first) > 0) != (side_of(a.first, a.second, b.second) > 0) &&
         (side_of(b.first, b.second, a.first) > 0) != (side_of(b.first, b.second, a.second) > 0);
}

/// The sides of a loop that reach into a box.
std::vector<Side> sides_within(const SectionLoop& loop, const PlanPoint& low, const PlanPoint& high) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const PlanPoint &a = loop.points[i], &b = loop.points[(i + 1) % loop.points.size()];
    if (std::max(a.x, b.x) >= low.x && std::min(a.x, b.x) <= high.x && std::max(a.z, b.z) >= low.z &&
        std::min(a.z, b.z) <= high.z)
      sides.emplace_back(a, b);
  }
  return sides;
}

constexpr double narrow = 0.6;          // chord over outline
constexpr double small_part = 0.25;     // of the area
constexpr double least_outline = 0.05;  // m, of a limb; folds of the skin have less
/// Number of ends of chords tried along an outline: one every third of a centimetre for a trunk.
constexpr std::size_t most_ends = 300;

double distance(const PlanPoint& a, const PlanPoint& b) { return std::hypot(a.x - b.x, a.z - b.z); }
/// Whether two points are farther apart than `far`, m, by more than rounding errors. Faster than distance().
bool are_surely_farther(const PlanPoint& a, const PlanPoint& b, double far) {
  const double x = a.x - b.x, z = a.z - b.z;
  return x * x + z * z > (1 + 1e-9) * far * far;
}

/// The part of a loop from its point `first` to its point `last`, around the loop's start if `last` is
/// smaller.
struct Stretch {
  std::size_t first = 0, last = 0;
};

/// Prefix sums of lengths and areas along a loop: those of any stretch take two look-ups.
class Outline {
 public:
  explicit Outline(const std::vector<PlanPoint>& points) : points_(points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PlanPoint& next = points[(i + 1) % points.size()];
      length_.push_back(length_.back() + distance(points[i], next));
      twice_area_.push_back(twice_area_.back() + cross(points[i], next));
    }
  }

  std::size_t size() const { return points_.size(); }
  const PlanPoint& operator[](std::size_t i) const { return points_[i]; }
  double length(const Stretch& s) const { return between(length_, s); }
  /// The area that the stretch and its chord enclose, as a fraction of the loop's; negative if the chord runs
  /// outside.
  double fraction(const Stretch& s) const {
    return (between(twice_area_, s) + cross(points_[s.last], points_[s.first])) / twice_area_.back();
  }
  bool is_on_one_side(const Stretch& s) const {
    const bool is_right = points_[s.first].x < 0;
    for (std::size_t i = s.first; i != s.last; i = (i + 1) % size())
      if ((points_[i].x < 0) != is_right) return false;
    return (points_[s.last].x < 0) == is_right;
  }

 private:
  static double between(const std::vector<double>& sums, const Stretch& s) {
    return sums[s.last] - sums[s.first] + (s.first <= s.last ? 0 : sums.back());
  }

  const std::vector<PlanPoint>& points_;
  std::vector<double> length_{0}, twice_area_{0};  // up to each point
};

std::optional<Stretch> narrowest(const SectionLoop& loop) {
  const Outline outline(loop.points);
  std::optional<Stretch> found;
  double least = narrow;
  const std::size_t stride = 1 + outline.size() / most_ends;
  for (std::size_t i = 0; i < outline.size(); i += stride)
    for (std::size_t j = i + stride; j < outline.size(); j += stride) {
      for (const Stretch& stretch : {Stretch{i, j}, Stretch{j, i}}) {
        const double length = outline.length(stretch);
        if (length < least_outline || are_surely_farther(outline[i], outline[j], least * length)) continue;
        const double fraction = outline.fraction(stretch);
        if (!(fraction > 0 && fraction <= small_part) || !outline.is_on_one_side(stretch)) continue;
        const double chord = distance(outline[i], outline[j]);
        if (chord >= least * length) continue;
        least = chord / length;
        found = stretch;
      }
    }
  return found;
}

SectionLoop cut_out(const SectionLoop& loop, const Stretch& stretch) {
  std::vector<PlanPoint> points;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = stretch.first; i != stretch.last; i = (i + 1) % loop.points.size()) {
    points.push_back(loop.points[i]);
    triangles.push_back(loop.triangles[i]);
  }
  points.push_back(loop.points[stretch.last]);
  triangles.push_back(triangles.back());  // the chord lies in no triangle
  return loop_of(std::move(points), std::move(triangles));
}

}  // namespace

std::vector<SectionLoop> section_loops(const Surface& surface, std::span<const std::uint32_t> triangles,
                                       double y) {
  std::vector<CutTriangle> cuts = cut_triangles(surface, triangles, y);
  std::unordered_map<std::uint64_t, std::size_t> entered_by;
  entered_by.reserve(cuts.size());
  for (std::size_t i = 0; i < cuts.size(); ++i) entered_by.emplace(cuts[i].in, i);
  std::vector<SectionLoop> loops;
  for (std::size_t first = 0; first < cuts.size(); ++first) {
    if (cuts[first].done) continue;
    std::vector<PlanPoint> points;
    std::vector<std::uint32_t> through;
    for (std::size_t i = first; !cuts[i].done; i = entered_by.at(cuts[i].out)) {
      cuts[i].done = true;
      points.push_back(cuts[i].at);
      through.push_back(cuts[i].triangle);
    }
    loops.push_back(loop_of(std::move(points), std::move(through)));
  }
  return loops;
}

SectionLoop loop_of(std::vector<PlanPoint> points, std::vector<std::uint32_t> triangles) {
  SectionLoop loop;
  loop.area = 0.5 * std::abs(twice_area(points));
  loop.low = loop.high = points.front();
  for (const PlanPoint& point : points) {
    loop.low = {std::min(loop.low.x, point.x), std::min(loop.low.z, point.z)};
    loop.high = {std::max(loop.high.x, point.x), std::max(loop.high.z, point.z)};
  }
  loop.points = std::move(points);
  loop.triangles = std::move(triangles);
  return loop;
}

bool overlap(const SectionLoop& a, const SectionLoop& b) {
  const PlanPoint low{std::max(a.low.x, b.low.x), std::max(a.low.z, b.low.z)};
  const PlanPoint high{std::min(a.high.x, b.high.x), std::min(a.high.z, b.high.z)};
  if (low.x > high.x || low.z > high.z) return false;
  if (contains(a, b.points.front()) || contains(b, a.points.front())) return true;
  const std::vector<Side> of_a = sides_within(a, low, high), of_b = sides_within(b, low, high);
  return std::ranges::any_of(of_a, [&](const Side& side) {
    return std::ranges::any_of(of_b, [&](const Side& other) { return cross_each_other(side, other); });
  });
}

std::vector<SectionLoop> cut_at_necks(SectionLoop loop) {
  constexpr int most = 4;
  std::vector<SectionLoop> loops{std::move(loop)};
  for (int cut = 0; cut < most; ++cut) {
    const std::optional<Stretch> part = narrowest(loops.front());
    if (!part) break;
    loops.push_back(cut_out(loops.front(), *part));
    loops.front() = cut_out(loops.front(), {part->last, part->first});
  }
  return loops;
}

}  // namespace mssim
