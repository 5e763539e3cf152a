#include "garment/body/body_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "text/error.h"

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
  std::ranges::sort(chords, {}, [](const Chord& chord) { return chord.from.x; });
  return chords;
}

/// The box of one side of a section, and the covered part of its width.
struct Half {
  PlanPoint least{HUGE_VAL, HUGE_VAL}, most{-HUGE_VAL, -HUGE_VAL};
  double covered = 0;

  void add(const Chord& chord) {
    covered += std::max(0.0, chord.to.x - std::max(chord.from.x, most.x));
    least = {std::min(least.x, chord.from.x), std::min({least.z, chord.from.z, chord.to.z})};
    most = {std::max(most.x, chord.to.x), std::max({most.z, chord.from.z, chord.to.z})};
  }
  PlanPoint middle() const { return {(least.x + most.x) / 2, (least.z + most.z) / 2}; }
};

/// The gap between the legs at this height; none if the section does not divide into two halves of about
/// equal width.
std::optional<LegGap> leg_gap(const Surface& body, double height) {
  constexpr double least_gap = 1e-3;  // of the section's width: more than gaps by rounding
  // Width over that of the wider half; hands and objects next to the body are narrower.
  constexpr double least_share = 0.55;
  const std::vector<Chord> chords = chords_at(body, height);
  if (chords.empty()) return std::nullopt;
  Half all;
  for (const Chord& chord : chords) all.add(chord);
  std::optional<LegGap> best;
  double best_share = least_share, reached = chords.front().to.x;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    const LegGap gap{height, reached, chords[i].from.x, {}, {}};
    reached = std::max(reached, chords[i].to.x);
    if (gap.high - gap.low <= least_gap * all.covered) continue;
    Half right, left;
    for (std::size_t j = 0; j < chords.size(); ++j) (j < i ? right : left).add(chords[j]);
    const auto [narrower, wider] = std::minmax({right.covered, left.covered});
    if (narrower < best_share * wider) continue;
    best_share = narrower / wider;
    best = {gap.height, gap.low, gap.high, right.middle(), left.middle()};
  }
  return best;
}

/// The middle of the box around points.
PlanPoint middle_of(const std::vector<PlanPoint>& points) {
  const auto [right, left] = std::ranges::minmax_element(points, {}, &PlanPoint::x);
  const auto [behind, before] = std::ranges::minmax_element(points, {}, &PlanPoint::z);
  return {(right->x + left->x) / 2, (behind->z + before->z) / 2};
}

using Corners = std::array<Vec3d, 3>;

/// Calls `visit` with each corner of a triangle in the plane of constant `coordinate` = `value`, and with
/// each point in which an edge passes through that plane.
template <class Visit>
void cut(const Corners& corners, double Vec3d::*coordinate, double value, const Visit& visit) {
  const auto [low, high] =
      std::minmax({corners[0].*coordinate, corners[1].*coordinate, corners[2].*coordinate});
  if (low > value || high < value) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& from = corners[i];
    const Vec3d& to = corners[(i + 1) % 3];
    const double before = from.*coordinate - value;
    const double behind = to.*coordinate - value;
    if (before == 0) visit(from);
    if ((before < 0 && behind > 0) || (before > 0 && behind < 0))
      visit(from + before / (before - behind) * (to - from));
  }
}

Corners corners_of(const Surface& surface, std::size_t triangle) {
  const auto& [a, b, c] = surface.triangles[triangle];
  return {surface.points[a], surface.points[b], surface.points[c]};
}

/// The range in which a landmark is searched, for adults and children, and its place on the reference body,
/// used if the body does not show it; in heights of the crotch.
struct Search {
  double low, high, usual;
};
constexpr Search waist_search{1.16, 1.52, 1.35}, hip_search{1.05, 1.25, 1.12}, knee_search{0.46, 0.75, 0.60},
    ankle_search{0.06, 0.25, 0.12};

using Girth = std::function<std::optional<double>(double)>;

/// The height within the range with the least girth, or for a negative `sign` the greatest. An extreme at an
/// end of the range, or next to a height without girth, is not a landmark; then the usual height counts.
Landmark extreme(const Girth& girth, const Search& search, double crotch, double sign) {
  constexpr std::size_t steps = 100;
  const auto fraction = [&](std::size_t step) {
    return search.low + (search.high - search.low) * static_cast<double>(step) / steps;
  };
  std::vector<std::optional<double>> girths;
  std::size_t best = 0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const std::optional<double> there = girths.emplace_back(girth(crotch * fraction(i))),
                                least = girths[best];
    if (there && (!least || sign * *there < sign * *least)) best = i;
  }
  const bool shows = best > 0 && best < steps && girths[best - 1] && girths[best + 1];
  const double height = crotch * (shows ? fraction(best) : search.usual);
  return {height, girth(height), !shows};
}

}  // namespace

std::vector<LegGap> leg_gaps(const Surface& body) {
  constexpr int steps = 120;
  constexpr int first = 6, last = 72;  // from the feet to well above any crotch
  const auto [low, high] = std::ranges::minmax(body.points, {}, &Vec3d::y);
  std::vector<LegGap> longest, run;
  for (int i = first; i <= last; ++i) {
    const auto gap = leg_gap(body, low.y + (high.y - low.y) * i / steps);
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

BodyProfile::BodyProfile(const Surface& surface, std::string name)
    : name_(std::move(name)),
      body_((validate_surface(surface, name_), mssim::trunk_and_legs(surface))),
      slices_(body_.surface),
      middle_(heights_in_the_middle()),
      right_foot_(lowest_point(-1)),
      left_foot_(lowest_point(1)),
      crotch_(find_crotch()) {}

std::vector<HeightRange> BodyProfile::merged(std::vector<HeightRange> intervals) {
  constexpr double joins = 1e-6;  // m, more than gaps by rounding between triangles that share a point
  std::ranges::sort(intervals, {}, &HeightRange::low);
  std::vector<HeightRange> pieces;
  for (const HeightRange& interval : intervals)
    if (pieces.empty() || interval.low > pieces.back().high + joins)
      pieces.push_back(interval);
    else
      pieces.back().high = std::max(pieces.back().high, interval.high);
  return pieces;
}

std::vector<HeightRange> BodyProfile::heights_in_the_middle() const {
  std::vector<HeightRange> intervals;
  for (std::size_t t = 0; t < body_.surface.triangles.size(); ++t) {
    HeightRange interval{highest(), lowest()};
    cut(corners_of(body_.surface, t), &Vec3d::x, 0, [&](const Vec3d& point) {
      interval = {std::min(interval.low, point.y), std::max(interval.high, point.y)};
    });
    if (interval.low <= interval.high) intervals.push_back(interval);
  }
  return merged(std::move(intervals));
}

std::optional<double> BodyProfile::find_crotch() const {
  // The trunk is the longest piece: feet may touch each other or an object.
  const auto trunk = std::ranges::max_element(
      middle_, {}, [](const HeightRange& interval) { return interval.high - interval.low; });
  if (trunk == middle_.end()) return std::nullopt;
  constexpr double shortest_leg = 0.01;  // m: the lowest point of a round underside need not be at x = 0
  if (std::max(right_foot_, left_foot_) >= trunk->low - shortest_leg) return std::nullopt;
  return trunk->low;
}

double BodyProfile::lowest_point(int side) const {
  double lowest = HUGE_VAL;
  for (const Vec3d& point : body_.surface.points)
    if (side * point.x > 0) lowest = std::min(lowest, point.y);
  return lowest;
}

double BodyProfile::crotch_height() const {
  if (!crotch_)
    throw InputError(name_ +
                     ": its section never divides into a left and a right leg at x = 0; give a body that is "
                     "upright in y, faces +z and has one leg on each side of x = 0");
  return *crotch_;
}

std::vector<PlanPoint> BodyProfile::section(double y) const {
  if (!(y >= lowest() && y <= highest()))
    throw InputError("{}: there is no section at the height {} m; give a height from {} to {} m", name_,
                     shown(y), shown(lowest()), shown(highest()));
  std::vector<PlanPoint> points;
  for (const std::uint32_t t : slices_.at(y))
    cut(corners_of(body_.surface, t), &Vec3d::y, y, [&](const Vec3d& point) {
      points.push_back({point.x, point.z});
    });
  if (points.empty())
    throw InputError(name_ + ": there is a gap between its parts at the height " + shown(y) +
                     " m; give a height of a part");
  return points;
}

double BodyProfile::hull_girth(double y) const { return hull_perimeter(section(y)); }

std::vector<PlanPoint> BodyProfile::leg_section(double y, int side) const {
  for (const HeightRange& joined : middle_)
    if (joined.contains(y))
      throw InputError(name_ + ": its legs are not apart at x = 0 at the height " + shown(y) +
                       " m; give a height outside " + shown(joined.low) + " to " + shown(joined.high) + " m");
  std::vector<PlanPoint> points = section(y);
  const double sign = side < 0 ? -1 : 1;
  std::erase_if(points, [&](const PlanPoint& point) { return sign * point.x <= 0; });
  if (points.empty())
    throw InputError("{}: there is no leg at x {} 0 at the height {} m; give a height that this leg reaches",
                     name_, side < 0 ? '<' : '>', shown(y));
  return points;
}

double BodyProfile::front_share(double y, double z) const {
  const std::vector<PlanPoint> points = section(y);
  const double aside = half_width(y);
  const auto half = [&](double sign) {
    std::vector<PlanPoint> part{{-aside, z}, {aside, z}};
    for (const PlanPoint& point : points)
      if (sign * (point.z - z) > 0) part.push_back(point);
    return hull_perimeter(std::move(part)) - 2 * aside;
  };
  const double front = half(1), back = half(-1);
  return front / (front + back);
}

double BodyProfile::crotch_length(double y) const {
  const double crotch = crotch_height();
  if (!(y > crotch && y < highest()))
    throw InputError(name_ + ": a tape through its crotch, " + shown(crotch) +
                     " m high, cannot start at the height " + shown(y) + " m; give a height from there to " +
                     shown(highest()) + " m");
  // {z, y} in the plane, up to the ends of the tape.
  std::vector<PlanPoint> outline;
  double front = -HUGE_VAL, back = HUGE_VAL;
  for (std::size_t t = 0; t < body_.surface.triangles.size(); ++t) {
    std::vector<Vec3d> ends;
    cut(corners_of(body_.surface, t), &Vec3d::x, 0, [&](const Vec3d& point) { ends.push_back(point); });
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Vec3d &from = ends[i], &to = ends[(i + 1) % ends.size()];
      if (from.y >= crotch && from.y <= y) outline.push_back({from.z, from.y});
      if ((from.y <= y) == (to.y <= y)) continue;
      const double z = from.z + (y - from.y) / (to.y - from.y) * (to.z - from.z);
      front = std::max(front, z);
      back = std::min(back, z);
    }
  }
  outline.push_back({front, y});
  outline.push_back({back, y});
  return hull_perimeter(std::move(outline)) - (front - back);
}

double BodyProfile::leg_girth(double y, int side) const { return hull_perimeter(leg_section(y, side)); }

double BodyProfile::within_leg(double y, int side) const {
  constexpr double from_its_ends = 0.005;
  const double foot = side < 0 ? right_foot_ : left_foot_;
  return std::clamp(y, foot + from_its_ends, crotch_height() - from_its_ends);
}

bool BodyProfile::legs_are_apart(double y) const {
  return std::ranges::none_of(middle_, [&](const HeightRange& joined) {
    return joined.contains(within_leg(y, -1)) || joined.contains(within_leg(y, 1));
  });
}

PlanPoint BodyProfile::leg_middle(double y, int side) const {
  return middle_of(leg_section(within_leg(y, side), side));
}

PlanPoint BodyProfile::middle(double y) const { return middle_of(section(y)); }

double BodyProfile::front(double y) const { return std::ranges::max(section(y), {}, &PlanPoint::z).z; }

double BodyProfile::back(double y) const { return std::ranges::min(section(y), {}, &PlanPoint::z).z; }

double BodyProfile::half_width(double y) const {
  double widest = 0;
  for (const PlanPoint& point : section(y)) widest = std::max(widest, std::abs(point.x));
  return widest;
}

std::optional<double> thicker_leg(const BodyProfile& profile, double y) {
  try {
    return std::max(profile.leg_girth(y, -1), profile.leg_girth(y, 1));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

BodyLandmarks find_landmarks(const BodyProfile& profile) {
  constexpr double below_the_crotch = 0.01;  // m
  const double crotch = profile.crotch_height();
  const Girth trunk = [&](double y) -> std::optional<double> {
    if (y >= profile.highest()) return std::nullopt;
    return profile.hull_girth(y);
  };
  const Girth leg = [&](double y) { return thicker_leg(profile, y); };
  BodyLandmarks found;
  found.crotch_height = crotch;
  found.hip = extreme(trunk, hip_search, crotch, -1);
  Search above_the_hip = waist_search;
  above_the_hip.low = std::max(above_the_hip.low, found.hip.height / crotch);
  found.waist = extreme(trunk, above_the_hip, crotch, 1);
  found.thigh = {crotch - below_the_crotch, leg(crotch - below_the_crotch), false};
  found.knee = extreme(leg, knee_search, crotch, 1);
  found.ankle = extreme(leg, ankle_search, crotch, 1);
  return found;
}

}  // namespace mssim
