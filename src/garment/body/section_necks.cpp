#include "garment/body/section_necks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace mssim {
namespace {

constexpr double narrow = 0.6;          // chord over outline
constexpr double small_part = 0.25;     // of the area
constexpr double least_outline = 0.05;  // m, of what is a limb rather than a fold of the skin
/// Ends of chords that are tried along an outline: of a trunk's, every third of a centimetre.
constexpr std::size_t most_ends = 300;

double distance(const PlanPoint& a, const PlanPoint& b) { return std::hypot(a.x - b.x, a.z - b.z); }
/// Are two points farther apart than that, m, whatever rounding does? Takes a fraction of the distance's
/// time.
bool are_surely_farther(const PlanPoint& a, const PlanPoint& b, double far) {
  const double x = a.x - b.x, z = a.z - b.z;
  return x * x + z * z > (1 + 1e-9) * far * far;
}
double cross(const PlanPoint& a, const PlanPoint& b) { return a.x * b.z - a.z * b.x; }

/// The part of a loop from its point `first` to its point `last`, round its beginning where that is smaller.
struct Stretch {
  std::size_t first = 0, last = 0;
};

/// Lengths and areas along a loop, so that those of any stretch take two look-ups.
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
  /// What the stretch and its chord enclose, as a share of what the loop does; negative where the chord runs
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
