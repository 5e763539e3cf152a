#include "garment/body/stance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "garment/body/body_profile.h"
#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

constexpr std::array<LengthUnit, 6> table{
    {{"m", 1}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}, {"foot", 0.3048}}};

/// Factor by which this height, m, is too small or too large for a person; 1 for a person.
double misfit(double height) { return std::max({1.0, shortest_person / height, height / tallest_person}); }

constexpr std::array<Vec3d, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// The body in one possible stance.
struct Candidate {
  BodyStance stance;
  Surface body;
  std::vector<LegGap> gaps;

  Candidate(const Surface& surface, UpAxis up, Facing facing) : stance{1, up, facing, 0, {}} {
    stand(surface);
  }

  /// Updates body and gaps after a change of stance.
  void stand(const Surface& surface) {
    body = stood_up(surface, stance);
    gaps = leg_gaps(body);
  }

  /// The distance between the legs, summed over all heights: largest if legs are seen from the front.
  double apartness() const {
    double sum = 0;
    for (const LegGap& gap : gaps) sum += gap.high - gap.low;
    return sum;
  }
};

std::vector<UpAxis> possible_axes(const Surface& body, const GivenStance& given) {
  if (given.up) return {*given.up};
  if (given.facing && !is_level(*given.facing, UpAxis::y)) return {UpAxis::z};
  if (given.facing && !is_level(*given.facing, UpAxis::z)) return {UpAxis::y};
  // The span of arms held sideways is about a person's height.
  constexpr double least_share = 0.75;
  const Vec3d size = box_of(body.points).size();
  const double least = least_share * std::max({size.x, size.y, size.z});
  std::vector<UpAxis> possible;
  for (const UpAxis up : {UpAxis::y, UpAxis::z})
    if (dot(size, direction_of(up)) >= least) possible.push_back(up);
  if (possible.empty())
    throw InputError("it is " + shown(size.x) + " long in x, " + shown(size.y) + " in y and " +
                     shown(size.z) +
                     " in z, so that it is upright neither in y nor in z; turn it in the file");
  return possible;
}

std::vector<Candidate> candidates(const Surface& body, const GivenStance& given) {
  std::vector<Candidate> all;
  for (const UpAxis up : possible_axes(body, given)) {
    if (given.facing) {
      if (!is_level(*given.facing, up))
        throw InputError("it cannot look along {}, which is its upright axis; give another facing",
                         up_axis_names.at(static_cast<std::size_t>(up)));
      all.emplace_back(body, up, *given.facing);
      continue;
    }
    for (const Facing facing : {Facing::plus_x, Facing::plus_y, Facing::plus_z})
      if (is_level(facing, up)) all.emplace_back(body, up, facing);
  }
  return all;
}

/// How much farther the feet reach forwards than backwards from the shins, over their length; positive if the
/// body faces +z.
double toes_ahead(const Surface& body) {
  const Box<double> box = box_of(body.points);
  const double height = box.size().y;
  constexpr double foot = 0.05, shin_low = 0.08, shin_high = 0.2;  // of the height, above the floor
  double foot_low = HUGE_VAL, foot_high = -HUGE_VAL, shin_back = HUGE_VAL, shin_front = -HUGE_VAL;
  for (const Vec3d& point : body.points) {
    const double fraction = (point.y - box.low.y) / height;
    if (fraction <= foot) {
      foot_low = std::min(foot_low, point.z);
      foot_high = std::max(foot_high, point.z);
    } else if (fraction >= shin_low && fraction <= shin_high) {
      shin_back = std::min(shin_back, point.z);
      shin_front = std::max(shin_front, point.z);
    }
  }
  const double ahead = foot_high - shin_front, behind = shin_back - foot_low;
  const double fraction = (ahead - behind) / (foot_high - foot_low);
  return std::isfinite(fraction) ? fraction : 0;
}

/// The angle, in degrees, between the line through the legs' middles and the sideways axis; the median over
/// the gaps.
double turned_degrees(const std::vector<LegGap>& gaps) {
  std::vector<double> angles;
  for (const LegGap& gap : gaps)
    angles.push_back(std::atan2(gap.right.z - gap.left.z, gap.left.x - gap.right.x));
  if (angles.empty()) return 0;
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::nth_element(angles.begin(), middle, angles.end());
  return *middle * 180 / std::numbers::pi;
}

Facing opposite(Facing facing) { return static_cast<Facing>(static_cast<std::uint32_t>(facing) ^ 1U); }

/// Turns the candidate in whole degrees until its legs are side by side.
void turn_ahead(Candidate& best, const Surface& surface) {
  constexpr int turns = 2;  // in an oblique view, the middles of legs are inexact
  for (int i = 0; i < turns; ++i) {
    best.stance.turn_deg -= std::round(turned_degrees(best.gaps));
    best.stand(surface);
  }
}

void find_facing(Candidate& best, const Surface& surface, const GivenStance& given,
                 std::vector<std::string>& doubts) {
  constexpr double clear = 0.15;  // a foot of 25 cm: toes reach 4 cm farther forwards than heels backwards
  constexpr double askew = 12;    // degrees: less may be one foot in front of the other
  const double turned = std::round(turned_degrees(best.gaps));
  if (std::abs(turned) > askew && given.facing)
    doubts.push_back("facing: its legs are " + shown(turned) +
                     " degrees off the axis; turn_deg in the scene's surface_file turns it");
  if (given.facing) return;
  if (std::abs(turned) > askew) {
    turn_ahead(best, surface);
    doubts.push_back("facing: its legs are oblique to the axes, so mssim turns it by " +
                     shown(best.stance.turn_deg) + " degrees; give --facing to prevent this");
  }
  const double toes = toes_ahead(best.body);
  if (toes < 0) {
    best.stance.facing = opposite(best.stance.facing);
    best.stand(surface);
  }
  if (std::abs(toes) < clear)
    doubts.emplace_back("facing: its feet reach about as far forwards as backwards; give it with --facing");
}

double unit_of(double height, const GivenStance& given, std::vector<std::string>& doubts) {
  const auto metres = [&](double unit_m) { return shown(std::round(1e4 * height * unit_m) / 1e4) + " m"; };
  if (given.unit_m) {
    const double person = height * *given.unit_m;
    if (person < shortest_person || person > tallest_person)
      doubts.push_back(fmt::format("unit: the body is {} high in the given unit, but people are {} to {} m",
                                   metres(*given.unit_m), shown(shortest_person), shown(tallest_person)));
    return *given.unit_m;
  }
  const auto guess = guess_unit(height);
  if (!guess)
    throw InputError("it is {} high, which is no person of {} to {} m in any unit; give the unit with --unit",
                     shown(height), shown(shortest_person), shown(tallest_person));
  if (!guess->certain)
    doubts.push_back(fmt::format(
        "unit: in {} the body is {} high, nearest to a person of {} to {} m; give the unit with --unit",
        guess->unit.name, metres(guess->unit.metres), shown(shortest_person), shown(tallest_person)));
  return guess->unit.metres;
}

/// To a tenth of a millimetre; without the sign of zero.
double to_tenths(double metres) { return std::round(1e4 * metres) / 1e4 + 0.0; }

}  // namespace

std::span<const LengthUnit> length_units() { return table; }

std::string unit_names() {
  std::string names;
  for (const LengthUnit& unit : table) names += std::string(unit.name) + ", ";
  return names;
}

std::optional<UnitGuess> guess_unit(double height) {
  constexpr double largest_misfit = 1.5;
  const auto misfit_in = [&](const LengthUnit& unit) { return misfit(height * unit.metres); };
  const LengthUnit& best = *std::ranges::min_element(table, {}, misfit_in);
  if (!(height > 0) || misfit_in(best) > largest_misfit) return std::nullopt;
  return UnitGuess{best, misfit_in(best) == 1};
}

Vec3d direction_of(UpAxis up) { return up == UpAxis::y ? axes[1] : axes[2]; }

Vec3d direction_of(Facing facing) {
  const auto number = static_cast<std::size_t>(facing);
  return (number % 2 == 0 ? 1.0 : -1.0) * axes.at(number / 2);
}

bool is_level(Facing facing, UpAxis up) { return dot(direction_of(facing), direction_of(up)) == 0; }

Surface stood_up(Surface body, const BodyStance& stance) {
  const Vec3d up = direction_of(stance.up), ahead = direction_of(stance.facing), left = cross(up, ahead);
  // Without a turn these are 1 and 0, so that positions are bitwise identical.
  const double turn = stance.turn_deg * std::numbers::pi / 180, cosine = std::cos(turn),
               sine = std::sin(turn);
  for (Vec3d& point : body.points) {
    const double x = dot(point, left), z = dot(point, ahead);
    const Vec3d turned{cosine * x + sine * z, dot(point, up), cosine * z - sine * x};
    point = stance.unit_m * turned + stance.move;
  }
  return body;
}

StanceGuess guess_stance(const Surface& body, const GivenStance& given) {
  std::vector<Candidate> all = candidates(body, given);
  const auto best = std::ranges::max_element(all, {}, &Candidate::apartness);
  std::vector<std::string> doubts;
  if (best->gaps.empty() && !(given.up && given.facing))
    doubts.push_back(fmt::format("{}: it has no two legs side by side to tell by; give {}",
                                 given.facing ? "up"
                                 : given.up   ? "facing"
                                              : "up and facing",
                                 given.facing ? "--up"
                                 : given.up   ? "--facing"
                                              : "--up and --facing"));
  find_facing(*best, body, given, doubts);
  const Box<double> box = box_of(best->body.points);
  BodyStance stance = best->stance;
  stance.unit_m = unit_of(box.size().y, given, doubts);
  const double middle = best->gaps.empty() ? box.middle().x : between_legs(best->gaps);
  stance.move = {to_tenths(-stance.unit_m * middle), to_tenths(-stance.unit_m * box.low.y),
                 to_tenths(-stance.unit_m * box.middle().z)};
  return {stance, doubts};
}

}  // namespace mssim
