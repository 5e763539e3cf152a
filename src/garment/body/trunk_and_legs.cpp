#include "garment/body/trunk_and_legs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

constexpr double rim = 0.03;  // m; 2 cm leave spikes, 4 cm join the openings of hip and armpit

/// Corners and middles of the triangles that do not stay, bottom up.
std::vector<Vec3d> left_out_points(const Surface& surface, const std::vector<bool>& stays) {
  std::vector<Vec3d> points;
  for (std::size_t t = 0; t < stays.size(); ++t) {
    if (stays[t]) continue;
    Vec3d sum;
    for (const std::uint32_t corner : surface.triangles[t]) {
      points.push_back(surface.points[corner]);
      sum += surface.points[corner];
    }
    points.push_back(1.0 / 3 * sum);
  }
  std::ranges::sort(points, {}, &Vec3d::y);
  return points;
}

/// Also removes triangles with a corner within 3 cm of a corner or middle of one that does not stay. After
/// cutting a hand off a hip, these are the lip between them, whose edge would stick out of the patch over the
/// cut, and spikes where they nearly touch.
void leave_out_rim(const Surface& surface, std::vector<bool>& stays) {
  const std::vector<Vec3d> left_out = left_out_points(surface, stays);
  std::vector<bool> is_near(surface.points.size());
  for (std::size_t i = 0; i < is_near.size(); ++i) {
    const Vec3d& point = surface.points[i];
    const auto begin = std::ranges::lower_bound(left_out, point.y - rim, {}, &Vec3d::y);
    for (auto other = begin; other != left_out.end() && other->y <= point.y + rim && !is_near[i]; ++other)
      is_near[i] = length(*other - point) <= rim;
  }
  for (std::size_t t = 0; t < stays.size(); ++t)
    stays[t] = stays[t] && std::ranges::none_of(surface.triangles[t],
                                                [&](std::uint32_t corner) { return is_near[corner]; });
}

/// Loops of one section that overlap.
struct Group {
  std::vector<SectionLoop> loops;
  double area = 0;       ///< m^2, of the largest loop
  bool by_neck = false;  ///< cut off another group
  bool kept = false;

  bool reaches_middle() const {
    return std::ranges::any_of(loops,
                               [](const SectionLoop& loop) { return loop.low.x <= 0 && loop.high.x >= 0; });
  }
};

bool overlap(const Group& a, const Group& b) {
  return std::ranges::any_of(a.loops, [&](const SectionLoop& loop) {
    return std::ranges::any_of(b.loops, [&](const SectionLoop& other) { return overlap(loop, other); });
  });
}

struct Level {
  double y = 0;  ///< m
  std::vector<Group> groups;
};

std::vector<Group> grouped(std::vector<SectionLoop> loops) {
  std::vector<Group> groups;
  for (SectionLoop& loop : loops) {
    Group joined;
    joined.area = loop.area;
    joined.loops.push_back(std::move(loop));
    std::erase_if(groups, [&](Group& group) {
      if (!overlap(group, joined)) return false;
      joined.area = std::max(joined.area, group.area);
      std::ranges::move(group.loops, std::back_inserter(joined.loops));
      return true;
    });
    groups.push_back(std::move(joined));
  }
  return groups;
}

/// A thigh has eight times the section of a hand, a trunk six times that of an arm; halves of a foot are
/// about equal.
constexpr double much_smaller = 0.25;

/// Splits large groups of a single loop at narrow necks into separate groups.
std::vector<Group> parted(std::vector<Group> groups) {
  double largest = 0;
  for (const Group& group : groups) largest = std::max(largest, group.area);
  std::vector<Group> all;
  for (Group& group : groups) {
    if (group.loops.size() > 1 || group.area < much_smaller * largest) {
      all.push_back(std::move(group));
      continue;
    }
    bool is_first = true;
    for (SectionLoop& loop : cut_at_necks(std::move(group.loops.front()))) {
      Group& part = all.emplace_back();
      part.area = loop.area;
      part.by_neck = !is_first;
      part.loops.push_back(std::move(loop));
      is_first = false;
    }
  }
  return all;
}

constexpr std::size_t slice_count = 256;

/// Sections through the middles of slices of equal height.
std::vector<Level> levels_of(const Surface& surface) {
  const HeightSlices slices(surface);
  const double lowest = slices.lowest(), step = (slices.highest() - lowest) / slice_count;
  std::vector<Level> levels(slice_count);
  for (std::size_t i = 0; i < slice_count; ++i) {
    levels[i].y = lowest + (static_cast<double>(i) + 0.5) * step;
    levels[i].groups = parted(grouped(section_loops(surface, slices.at(levels[i].y), levels[i].y)));
  }
  return levels;
}

/// The largest group of a level for which `may` is true; null if there is none.
template <class May>
Group* largest(Level& level, const May& may) {
  Group* found = nullptr;
  for (Group& group : level.groups)
    if ((found == nullptr || group.area > found->area) && std::invoke(may, group)) found = &group;
  return found;
}

/// Whether a group of the level, kept or not, overlaps this group of another level.
bool any_overlaps(const Level& level, bool kept, const Group& group) {
  return std::ranges::any_of(level.groups,
                             [&](const Group& other) { return other.kept == kept && overlap(other, group); });
}

/// The level in the middle of the longest run of levels that reach x = 0.
std::optional<std::size_t> middle_of_trunk(const std::vector<Level>& levels) {
  std::size_t length = 0, longest = 0, middle = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    length = std::ranges::any_of(levels[i].groups, &Group::reaches_middle) ? length + 1 : 0;
    if (length <= longest) continue;
    longest = length;
    middle = i - length / 2;
  }
  return longest > 0 ? std::optional(middle) : std::nullopt;
}

/// Keeps groups that hang from those kept in the level above.
void keep_below(const Level& above, Level& level) {
  for (const Group& from : above.groups) {
    if (!from.kept) continue;
    const auto hangs = [&](const Group& group) { return overlap(from, group); };
    const Group* main = largest(level, hangs);
    if (main == nullptr) continue;
    const double least = much_smaller * main->area;
    for (Group& group : level.groups)
      if (!group.kept && group.area >= least && hangs(group)) group.kept = true;
  }
}

/// Keeps groups on top of those kept in the levels below, unless they lead back to the trunk.
void keep_above(std::vector<Level>& levels, std::size_t from) {
  std::vector<const Group*> trunk(levels.size());
  trunk[from] = largest(levels[from], [](const Group& group) { return group.kept; });
  std::size_t last = from;
  while (last + 1 < levels.size() && trunk[last] != nullptr) {
    Level& level = levels[last + 1];
    for (Group& group : level.groups) group.kept = any_overlaps(levels[last], true, group);
    trunk[last + 1] = largest(level, [&](const Group& group) { return overlap(*trunk[last], group); });
    ++last;
  }
  std::vector<const Group*> leading_back;
  for (std::size_t i = last; i-- > from + 1;) {
    std::vector<const Group*> leading;
    for (Group& group : levels[i].groups) {
      if (!group.kept || &group == trunk[i]) continue;
      const auto leads_to = [&](const Group* other) { return other != nullptr && overlap(group, *other); };
      if (leads_to(trunk[i + 1]) || std::ranges::any_of(leading_back, leads_to)) {
        group.kept = false;
        leading.push_back(&group);
      }
    }
    leading_back = std::move(leading);
  }
}

/// Keeps groups cut off at a neck that do not hang from a separate part above: they are no limb, or the start
/// of one, such as arms at the shoulders.
void keep_bulges(std::vector<Level>& levels) {
  for (std::size_t i = levels.size(); i-- > 0;)
    for (Group& group : levels[i].groups)
      if (group.by_neck && !group.kept)
        group.kept = i + 1 == levels.size() || !any_overlaps(levels[i + 1], false, group);
}

/// Whether each triangle stays: as its loop at the level nearest to its middle that cuts it, or as its
/// neighbours if no level cuts it.
std::vector<bool> staying(const Surface& surface, const std::vector<Level>& levels) {
  enum class Part : std::uint8_t { unknown, other, kept };
  std::vector<Part> of_triangle(surface.triangles.size(), Part::unknown);
  std::vector<double> nearest(surface.triangles.size(), std::numeric_limits<double>::infinity());
  for (const Level& level : levels)
    for (const Group& group : level.groups)
      for (const SectionLoop& loop : group.loops)
        for (const std::uint32_t t : loop.triangles) {
          const auto& [a, b, c] = surface.triangles[t];
          const auto [low, high] =
              std::minmax({surface.points[a].y, surface.points[b].y, surface.points[c].y});
          const double distance = std::abs(level.y - 0.5 * (low + high));
          if (distance >= nearest[t]) continue;
          nearest[t] = distance;
          of_triangle[t] = group.kept ? Part::kept : Part::other;
        }
  std::vector<Part> of_point(surface.points.size(), Part::unknown);
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (const std::uint32_t corner : surface.triangles[t])
        of_point[corner] = std::max(of_point[corner], of_triangle[t]);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (of_triangle[t] != Part::unknown) continue;
      for (const std::uint32_t corner : surface.triangles[t])
        of_triangle[t] = std::max(of_triangle[t], of_point[corner]);
      goes_on = goes_on || of_triangle[t] != Part::unknown;
    }
  }
  std::vector<bool> stays(surface.triangles.size());
  for (std::size_t t = 0; t < stays.size(); ++t) stays[t] = of_triangle[t] != Part::other;
  return stays;
}

void include(std::optional<HeightRange>& range, double y) {
  if (!range) range = {y, y};
  range->low = std::min(range->low, y);
  range->high = std::max(range->high, y);
}

/// "at 0.86 m", or "from 0.84 to 0.86 m", to a millimetre.
std::string shown(const HeightRange& range) {
  const auto millimetres = [](double y) { return decimal(std::round(y * 1e3) / 1e3); };
  const std::string low = millimetres(range.low), high = millimetres(range.high);
  return low == high ? fmt::format("at {} m", low) : fmt::format("from {} to {} m", low, high);
}

/// The triangles that stay, with their points.
Surface part_of(const Surface& surface, const std::vector<bool>& stays) {
  Surface part;
  PointNumbers<std::uint32_t> numbers(part);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!stays[t]) continue;
    for (std::uint32_t& corner : part.triangles.emplace_back(surface.triangles[t]))
      corner = numbers.of(corner, [&] { return surface.points[corner]; });
  }
  return part;
}

}  // namespace

HeightSlices::HeightSlices(const Surface& surface) : slices_(slice_count) {
  const auto [low, high] = std::ranges::minmax(surface.points, {}, &Vec3d::y);
  lowest_ = low.y;
  highest_ = high.y;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto [least, most] = std::minmax({surface.points[a].y, surface.points[b].y, surface.points[c].y});
    for (std::size_t i = slice_of(least); i <= slice_of(most); ++i) slices_[i].push_back(t);
  }
}

std::size_t HeightSlices::slice_of(double y) const {
  const double fraction = (y - lowest_) / (highest_ - lowest_);
  return std::min(static_cast<std::size_t>(fraction * slice_count), slice_count - 1);
}

TrunkAndLegs trunk_and_legs(const Surface& surface) {
  std::vector<Level> levels = levels_of(surface);
  const std::optional<std::size_t> middle = middle_of_trunk(levels);
  if (!middle) return {surface, std::nullopt, std::nullopt};
  largest(levels[*middle], &Group::reaches_middle)->kept = true;
  keep_above(levels, *middle);
  for (std::size_t i = *middle; i-- > 0;) keep_below(levels[i + 1], levels[i]);

  keep_bulges(levels);
  TrunkAndLegs found;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    bool cut_from_kept = false;  // the part that others were cut off precedes them (parted)
    for (const Group& group : levels[i].groups) {
      if (!group.by_neck) cut_from_kept = group.kept;
      if (group.kept) continue;
      include(found.left_out, levels[i].y);
      if (group.by_neck && cut_from_kept) include(found.touched, levels[i].y);
      if (i > 0 && !any_overlaps(levels[i - 1], false, group) && any_overlaps(levels[i - 1], true, group))
        include(found.touched, levels[i - 1].y);
    }
  }
  if (!found.left_out) {
    found.surface = surface;
    return found;
  }
  std::vector<bool> stays = staying(surface, levels);
  if (found.touched) leave_out_rim(surface, stays);
  found.surface = part_of(surface, stays);
  if (found.touched)
    span_openings(found.surface);
  else
    close_openings(found.surface, std::numeric_limits<double>::infinity());
  return found;
}

std::string ignored_parts(const TrunkAndLegs& body) {
  if (!body.left_out) return "";
  return "garments ignore all but trunk and legs of the body (arms, hands, hair), " + shown(*body.left_out) +
         (body.touched ? fmt::format("; {} these parts touch the body, and its measures are uncertain",
                                     shown(*body.touched))
                       : "");
}

}  // namespace mssim
