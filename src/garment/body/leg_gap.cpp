#include "garment/body/leg_gap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace mssim {
namespace {

/// A triangle's part of a horizontal section.
struct Chord {
  PlanPoint from, to;  ///< from.x <= to.x
};

std::vector<Chord> chords_at(const Surface& body, double height) {
  std::vector<Chord> chords;
  for (const auto& triangle : body.triangles) {
    std::vector<PlanPoint> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& a = body.points[triangle[i]];
      const Vec3d& b = body.points[triangle[(i + 1) % 3]];
      if ((a.y < height) == (b.y < height)) continue;
      const Vec3d crossing = a + (height - a.y) / (b.y - a.y) * (b - a);
      ends.push_back({crossing.x, crossing.z});
    }
    if (ends.size() == 2) {
      const bool in_order = ends[0].x <= ends[1].x;
      chords.push_back({ends[in_order ? 0 : 1], ends[in_order ? 1 : 0]});
    }
  }
  std::sort(chords.begin(), chords.end(), [](const Chord& a, const Chord& b) { return a.from.x < b.from.x; });
  return chords;
}

/// What a side of a section covers: its box, and how much of its width.
class Half {
 public:
  void add(const Chord& chord) {
    covered_ += std::max(0.0, chord.to.x - std::max(chord.from.x, most_.x));
    least_ = {std::min(least_.x, chord.from.x), std::min({least_.z, chord.from.z, chord.to.z})};
    most_ = {std::max(most_.x, chord.to.x), std::max({most_.z, chord.from.z, chord.to.z})};
  }
  double covered() const { return covered_; }
  PlanPoint middle() const { return {(least_.x + most_.x) / 2, (least_.z + most_.z) / 2}; }

 private:
  PlanPoint least_{HUGE_VAL, HUGE_VAL}, most_{-HUGE_VAL, -HUGE_VAL};
  double covered_ = 0;
};

}  // namespace

std::optional<LegGap> leg_gap(const Surface& body, double height) {
  constexpr double least_gap = 1e-3;  // of the section's width: more than what rounding opens
  constexpr double least_share =
      0.55;  // of the wider half; hands and what stands beside the body are narrower
  const std::vector<Chord> chords = chords_at(body, height);
  if (chords.empty()) return std::nullopt;
  Half all;
  for (const Chord& chord : chords) all.add(chord);
  std::optional<LegGap> best;
  double best_share = least_share, reached = chords.front().to.x;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    const LegGap gap{height, reached, chords[i].from.x, {}, {}};
    reached = std::max(reached, chords[i].to.x);
    if (gap.high - gap.low <= least_gap * all.covered()) continue;
    Half right, left;
    for (std::size_t j = 0; j < chords.size(); ++j) (j < i ? right : left).add(chords[j]);
    const double narrower = std::min(right.covered(), left.covered());
    const double wider = std::max(right.covered(), left.covered());
    if (narrower < best_share * wider) continue;
    best_share = narrower / wider;
    best = {gap.height, gap.low, gap.high, right.middle(), left.middle()};
  }
  return best;
}

std::vector<LegGap> leg_gaps(const Surface& body) {
  constexpr int steps = 120;
  constexpr int first = 6, last = 72;  // from the feet to well above any crotch
  const auto [low, high] =
      std::ranges::minmax_element(body.points, {}, [](const Vec3d& point) { return point.y; });
  std::vector<LegGap> longest, run;
  for (int i = first; i <= last; ++i) {
    const auto gap = leg_gap(body, low->y + (high->y - low->y) * i / steps);
    if (gap)
      run.push_back(*gap);
    else
      run.clear();
    if (run.size() > longest.size()) longest = run;
  }
  return longest;
}

double between_legs(const std::vector<LegGap>& gaps) {
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (auto gap = gaps.rbegin(); gap != gaps.rend(); ++gap) {
    const double next_low = std::max(low, gap->low), next_high = std::min(high, gap->high);
    if (next_low >= next_high) break;
    low = next_low;
    high = next_high;
  }
  return (low + high) / 2;
}

}  // namespace mssim
