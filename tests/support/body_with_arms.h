#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "garment/body/mannequin.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"

namespace mssim {

/// Negative inside a body, positive outside, and near its surface about the distance from it, m.
using DistanceField = std::function<double(const Vec3d& point)>;

/// Where a field is looked at: at the corners of cubes that fill the box from `low` on.
struct FieldBox {
  Vec3d low;
  double cell = 0;                       ///< m
  std::array<std::uint32_t, 3> cells{};  ///< along x, y and z
};

/// The surface on which the field is 0, closed where the field is positive on the box's sides: marching
/// tetrahedra, six to a cube.
inline Surface isosurface(const DistanceField& field, const FieldBox& box) {
  const std::array<std::uint32_t, 3> corners{box.cells[0] + 1, box.cells[1] + 1, box.cells[2] + 1};
  const auto number = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return (j * corners[2] + k) * corners[0] + i;
  };
  std::vector<Vec3d> place(std::size_t{corners[0]} * corners[1] * corners[2]);
  std::vector<double> value(place.size());
  for (std::uint32_t j = 0; j < corners[1]; ++j)
    for (std::uint32_t k = 0; k < corners[2]; ++k)
      for (std::uint32_t i = 0; i < corners[0]; ++i) {
        const std::uint32_t n = number(i, j, k);
        place[n] = box.low + box.cell * Vec3d{double(i), double(j), double(k)};
        value[n] = field(place[n]);
      }

  Surface surface;
  std::unordered_map<std::uint64_t, std::uint32_t> on_edge;
  const auto crossing = [&](std::uint32_t inner, std::uint32_t outer) {
    const std::uint64_t edge = std::uint64_t{std::min(inner, outer)} << 32 | std::max(inner, outer);
    const auto [found, is_new] = on_edge.try_emplace(edge, surface.points.size());
    if (is_new) {
      // Not too near a corner: no triangle is without area.
      const double fraction = std::clamp(value[inner] / (value[inner] - value[outer]), 0.05, 0.95);
      surface.points.push_back(place[inner] + fraction * (place[outer] - place[inner]));
    }
    return found->second;
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vec3d& outwards) {
    const Vec3d &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    if (dot(cross(q - p, r - p), outwards) > 0)
      surface.triangles.push_back({a, b, c});
    else
      surface.triangles.push_back({a, c, b});
  };
  const auto cut = [&](const std::array<std::uint32_t, 4>& tetrahedron) {
    const auto inside = std::ranges::count_if(tetrahedron, [&](auto corner) { return value[corner] < 0; });
    if (inside == 0 || inside == 4) return;
    std::vector<std::uint32_t> in, out;
    for (const std::uint32_t corner : tetrahedron) (value[corner] < 0 ? in : out).push_back(corner);
    Vec3d outwards;
    for (const std::uint32_t corner : out) outwards += 1.0 / double(out.size()) * place[corner];
    for (const std::uint32_t corner : in) outwards += -1.0 / double(in.size()) * place[corner];
    if (in.size() == 1)
      add(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]), outwards);
    else if (out.size() == 1)
      add(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]), outwards);
    else {
      const std::uint32_t a = crossing(in[0], out[0]), b = crossing(in[0], out[1]),
                          c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
      add(a, b, c, outwards);
      add(a, c, d, outwards);
    }
  };
  // Each of the six goes from a cube's lowest corner to its highest along its sides in another order.
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    for (std::uint32_t j = 0; j < box.cells[1]; ++j)
      for (std::uint32_t k = 0; k < box.cells[2]; ++k)
        for (std::uint32_t i = 0; i < box.cells[0]; ++i) {
          std::array<std::uint32_t, 3> at{i, j, k};
          std::array<std::uint32_t, 4> tetrahedron{number(i, j, k)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[order[step]];
            tetrahedron[step + 1] = number(at[0], at[1], at[2]);
          }
          cut(tetrahedron);
        }
  } while (std::next_permutation(order.begin(), order.end()));
  return surface;
}

/// Makes a closed surface coarser until it has so many triangles: edges shrink to points, which are put on
/// the field's surface, short ones first, and such as do not bend. It stays closed and connected as it was.
class Decimation {
 public:
  Decimation(Surface surface, const DistanceField& field)
      : surface_(std::move(surface)),
        field_(field),
        around_(surface_.points.size()),
        version_(surface_.points.size()),
        left_(surface_.triangles.size()) {
    for (const Vec3d& point : surface_.points) outwards_.push_back(direction(slope(point)));
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
      for (const std::uint32_t corner : surface_.triangles[t]) around_[corner].push_back(t);
    for (std::uint32_t point = 0; point < around_.size(); ++point)
      for (const std::uint32_t other : neighbours(point))
        if (point < other) offer_edge(point, other);
  }

  Surface down_to(std::size_t triangles) && {
    while (left_ > triangles && !edges_.empty()) {
      const Edge edge = edges_.top();
      edges_.pop();
      if (version_[edge.a] == edge.version_a && version_[edge.b] == edge.version_b) collapse(edge.a, edge.b);
    }
    return packed();
  }

 private:
  using Numbers = std::vector<std::uint32_t>;

  /// As it was when neither of its ends had been moved since.
  struct Edge {
    double cost = 0;
    std::uint32_t a = 0, b = 0, version_a = 0, version_b = 0;
    bool operator<(const Edge& other) const {  // the cheapest on top
      return std::tie(cost, a, b) > std::tie(other.cost, other.a, other.b);
    }
  };

  static bool has(const Numbers& numbers, std::uint32_t wanted) {
    return std::ranges::find(numbers, wanted) != numbers.end();
  }

  Numbers neighbours(std::uint32_t point) const {
    Numbers others;
    for (const std::uint32_t t : around_[point])
      for (const std::uint32_t corner : surface_.triangles[t])
        if (corner != point && !has(others, corner)) others.push_back(corner);
    return others;
  }

  void offer_edge(std::uint32_t a, std::uint32_t b) {
    constexpr double of_a_plane = 0.3;
    const double bend = length(outwards_[a] - outwards_[b]);
    const double cost = (of_a_plane + bend) * length(surface_.points[a] - surface_.points[b]);
    edges_.push({cost, a, b, version_[a], version_[b]});
  }

  /// The field's gradient.
  Vec3d slope(const Vec3d& point) const {
    constexpr double step = 1e-4;
    const double value = field_(point);
    return 1 / step *
           Vec3d{field_(point + Vec3d{step, 0, 0}) - value, field_(point + Vec3d{0, step, 0}) - value,
                 field_(point + Vec3d{0, 0, step}) - value};
  }

  static Vec3d direction(const Vec3d& vector) {
    const double size = length(vector);
    return size > 0 ? 1 / size * vector : Vec3d{};
  }

  /// Two steps of Newton's.
  Vec3d on_surface(Vec3d point) const {
    for (int turn = 0; turn < 2; ++turn) {
      const Vec3d uphill = slope(point);
      if (!(dot(uphill, uphill) > 0.04)) break;
      point += -field_(point) / dot(uphill, uphill) * uphill;
    }
    return point;
  }

  Vec3d normal(std::uint32_t triangle) const {
    const auto& [a, b, c] = surface_.triangles[triangle];
    return cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]);
  }

  /// Would a triangle that stays turn by more than about 70 degrees?
  bool turns_one(std::uint32_t point, std::uint32_t other, const Vec3d& to) {
    const Vec3d from = surface_.points[point];
    bool turned = false;
    for (const std::uint32_t t : around_[point]) {
      if (has(around_[other], t)) continue;
      const Vec3d before = normal(t);
      surface_.points[point] = to;
      const Vec3d after = normal(t);
      surface_.points[point] = from;
      turned = turned || !(dot(before, after) > 0.35 * length(before) * length(after));
    }
    return turned;
  }

  void collapse(std::uint32_t a, std::uint32_t b) {
    const Numbers beside_a = neighbours(a), beside_b = neighbours(b);
    const auto common =
        std::ranges::count_if(beside_a, [&](std::uint32_t point) { return has(beside_b, point); });
    // Otherwise the surface would touch itself.
    if (!has(beside_a, b) || common != 2 || beside_a.size() + beside_b.size() < 8) return;
    const Vec3d to = on_surface(0.5 * (surface_.points[a] + surface_.points[b]));
    if (length(to - surface_.points[a]) > length(surface_.points[b] - surface_.points[a]) ||
        turns_one(a, b, to) || turns_one(b, a, to))
      return;
    surface_.points[a] = to;
    outwards_[a] = direction(slope(to));
    for (const std::uint32_t t : Numbers(around_[b])) {
      auto& triangle = surface_.triangles[t];
      if (has(around_[a], t)) {
        for (const std::uint32_t corner : triangle) std::erase(around_[corner], t);
        triangle = {0, 0, 0};
        --left_;
      } else {
        std::ranges::replace(triangle, b, a);
        around_[a].push_back(t);
      }
    }
    around_[b].clear();
    ++version_[a];
    ++version_[b];
    for (const std::uint32_t other : neighbours(a)) offer_edge(a, other);
  }

  Surface packed() const {
    Surface surface;
    constexpr std::uint32_t unknown = UINT32_MAX;
    Numbers number(surface_.points.size(), unknown);
    for (auto triangle : surface_.triangles) {
      if (triangle[0] == triangle[1]) continue;
      for (std::uint32_t& corner : triangle) {
        if (number[corner] == unknown) {
          number[corner] = static_cast<std::uint32_t>(surface.points.size());
          surface.points.push_back(surface_.points[corner]);
        }
        corner = number[corner];
      }
      surface.triangles.push_back(triangle);
    }
    return surface;
  }

  Surface surface_;
  const DistanceField& field_;
  std::vector<Numbers> around_;  ///< the triangles of each point
  Numbers version_;
  std::vector<Vec3d> outwards_;  ///< of each point, of length 1
  std::priority_queue<Edge> edges_;
  std::size_t left_;
};

/// A person as a scanner sees one: one closed surface with head, arms and feet, of about the reference
/// body's measures and 1.70 m tall.
struct PersonForm {
  std::size_t triangles = 12'000;  ///< 1,600 or more, even
  bool arms = true;
  /// Between an arm and the vertical. At 12 there are 6 cm between hand and thigh, at 4 they touch.
  double arm_angle_degrees = 12;
  double arm_forward_degrees = 0;  ///< how far the arms are held before the body
};

/// How a file says where the person stands.
struct PersonPose {
  double unit_m = 1;        ///< metres in one unit of the file
  double turn_degrees = 0;  ///< about the upright axis, from facing +z towards +x
  Vec3d shift{};            ///< m, after the turn
  bool z_up = false;        ///< (x, y, z) becomes (x, -z, y): who faced +z faces -y
};

/// A section of trunk or leg: two halves of superellipses, |x/a|^n + |z/b|^n = 1, before and behind the line
/// in which it is widest; ellipses where n is 2.
struct BodySection {
  double height = 0;
  double x = 0, half_width = 0;
  double z = 0, front = 0, back = 0;  ///< where it is widest, and how far it reaches before and behind that
  double front_power = 2, back_power = 2;
};

inline BodySection body_section(const EllipseSection& ellipse) {
  return {.height = ellipse.height,
          .x = (ellipse.x_min + ellipse.x_max) / 2,
          .half_width = ellipse.half_width(),
          .z = (ellipse.z_min + ellipse.z_max) / 2,
          .front = ellipse.half_depth(),
          .back = ellipse.half_depth()};
}

/// An upright tube through sections, from below upwards, as a DistanceField.
class BodyTube {
 public:
  explicit BodyTube(const std::vector<BodySection>& sections)
      : low_(sections.front().height),
        high_(sections.back().height),
        x_(curve(sections, &BodySection::x)),
        z_(curve(sections, &BodySection::z)),
        half_width_(curve(sections, &BodySection::half_width)),
        front_(curve(sections, &BodySection::front)),
        back_(curve(sections, &BodySection::back)),
        front_power_(curve(sections, &BodySection::front_power)),
        back_power_(curve(sections, &BodySection::back_power)) {}

  double operator()(const Vec3d& p) const {
    const double y = std::clamp(p.y, low_, high_), before = p.z - z_(y);
    const double width = half_width_(y), depth = before > 0 ? front_(y) : back_(y);
    const double x = std::abs(p.x - x_(y)) / width, z = std::abs(before) / depth;
    // first: 1 on the surface; second: its slope times first^(n - 1)
    const double n = before > 0 ? front_power_(y) : back_power_(y);
    const double first = std::pow(std::pow(x, n) + std::pow(z, n), 1 / n);
    const double second = std::hypot(std::pow(x, n - 1) / width, std::pow(z, n - 1) / depth);
    const double beside =
        second > 0 ? std::pow(first, n - 1) * (first - 1) / second : -std::min(width, depth);
    const double beyond = std::abs(p.y - y);
    return beyond > 0 ? std::hypot(std::max(beside, 0.0), beyond) : beside;
  }

 private:
  static MonotoneCurve curve(const std::vector<BodySection>& sections, double BodySection::*value) {
    std::vector<double> heights, values;
    for (const BodySection& section : sections) {
      heights.push_back(section.height);
      values.push_back(section.*value);
    }
    return {heights, values};
  }

  double low_, high_;
  MonotoneCurve x_, z_, half_width_, front_, back_, front_power_, back_power_;
};

/// What a person's surface is made of: trunk and leg, from below upwards, and how much larger than a person
/// of 1.70 m head, feet and arms are.
struct PersonParts {
  std::vector<BodySection> torso, leg;
  double size = 1;
};

/// A person in formulas, as a DistanceField: smooth unions of tubes, cones and ellipsoids.
class Person {
 public:
  explicit Person(const PersonForm& form) : Person(form, reference_parts()) {}
  Person(const PersonForm& form, const PersonParts& parts)
      : arms_(form.arms), size_(parts.size), torso_(parts.torso), leg_(parts.leg) {
    const double aside = form.arm_angle_degrees * std::numbers::pi / 180;
    const double before = form.arm_forward_degrees * std::numbers::pi / 180;
    along_arm_ = {std::sin(aside), -std::cos(aside) * std::cos(before), std::cos(aside) * std::sin(before)};
  }

  double operator()(const Vec3d& at) const {
    const Vec3d p{std::abs(at.x), at.y, at.z};
    const Vec3d q = 1 / size_ * p;
    double body = join(torso_(p), leg_(p), 0.03);
    body = join(body, size_ * ellipsoid(q, {0, 1.585, 0.015}, {0.075, 0.115, 0.095}), 0.03);
    body = join(body, size_ * ellipsoid(q, {0.135, 0.035, 0.055}, {0.042, 0.038, 0.12}), 0.02);
    // Rounded at the shoulder; a hand beside the hip stays apart.
    const double rounding = std::clamp(0.1 * (q.y - 1.0), 0.004, 0.03);
    return arms_ ? join(body, size_ * arm(q), rounding) : body;
  }

 private:
  static PersonParts reference_parts() {
    PersonParts parts;
    std::ranges::transform(torso_sections(), std::back_inserter(parts.torso), body_section);
    std::ranges::transform(leg_sections(), std::back_inserter(parts.leg), body_section);
    return parts;
  }

  static std::vector<EllipseSection> torso_sections() {
    const BodyMeasures m;
    const EllipseSection hip = section_of_girth(m.hip.height, m.hip.girth, m.hip_aspect, 0, -0.006);
    // Up from the crotch, wide early and deep late, as on the mannequin.
    const auto seat = [&](double fraction, double width, double depth) {
      const double z = -0.006 * fraction;
      return EllipseSection{m.crotch_height + fraction * (m.hip.height - m.crotch_height), width * hip.x_min,
                            width * hip.x_max, z - depth * hip.half_depth(), z + depth * hip.half_depth()};
    };
    return {seat(0, 0.45, 0.30),
            seat(0.05, 0.70, 0.43),
            seat(0.12, 0.83, 0.55),
            seat(0.25, 0.94, 0.70),
            seat(0.5, 0.985, 0.88),
            hip,
            section_of_girth(0.95, 0.88, 0.75, 0, -0.002),
            section_of_girth(m.waist.height, m.waist.girth, 0.78, 0, 0.005),
            section_of_girth(1.15, 0.80, 0.75, 0, 0.004),
            section_of_girth(m.bust.height, m.bust.girth, 0.72, 0, 0.006),
            section_of_girth(1.34, 0.92, 0.56, 0, 0),
            section_of_girth(1.385, 0.84, 0.40, 0, -0.010),
            section_of_girth(1.415, 0.55, 0.60, 0, -0.012),
            section_of_girth(1.445, 0.38, 0.92, 0, -0.006),
            section_of_girth(1.56, 0.34, 1.0, 0, 0.004)};
  }

  static std::vector<EllipseSection> leg_sections() {
    const BodyMeasures m;
    const double thigh_axis = m.thigh_gap / 2 + m.thigh.girth / ellipse_perimeter(1, thigh_aspect);
    const auto section = [&](double height, double girth, double aspect, double z) {
      const double fraction = (m.thigh.height - height) / (m.thigh.height - m.ankle.height);
      return section_of_girth(height, girth, aspect, thigh_axis + fraction * (m.stance / 2 - thigh_axis), z);
    };
    return {section(0.03, 0.25, 1.2, 0), section(m.ankle.height, m.ankle.girth, 1.15, -0.002),
            section(0.16, 0.25, 1.05, -0.006), section(0.32, 0.36, 1.05, -0.012),
            section(m.knee.height, m.knee.girth, 1.05, 0), section(0.62, 0.49, 1.05, 0),
            section(m.thigh.height, m.thigh.girth, thigh_aspect, -0.003),
            // From here on within the torso.
            EllipseSection{0.80, 0.02, 0.166, -0.090, 0.075},
            EllipseSection{0.87, 0.03, 0.140, -0.070, 0.060}};
  }

  /// The smooth union of two bodies (Quilez's polynomial): rounded where they are nearer than `width`.
  static double join(double a, double b, double width) {
    const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - overlap * overlap * width / 4;
  }

  static double ellipsoid(const Vec3d& p, const Vec3d& middle, const Vec3d& half) {
    const Vec3d d = p - middle;
    const double first = length(Vec3d{d.x / half.x, d.y / half.y, d.z / half.z});
    const double second =
        length(Vec3d{d.x / (half.x * half.x), d.y / (half.y * half.y), d.z / (half.z * half.z)});
    return second > 0 ? first * (first - 1) / second : -std::min({half.x, half.y, half.z});
  }

  /// About a cone, with a ball at either end.
  static double cone(const Vec3d& p, const Vec3d& from, double radius, const Vec3d& to, double end_radius) {
    const Vec3d along = to - from;
    const double fraction = std::clamp(dot(p - from, along) / dot(along, along), 0.0, 1.0);
    return length(p - from - fraction * along) - (radius + fraction * (end_radius - radius));
  }

  double arm(const Vec3d& p) const {
    const Vec3d shoulder{0.172, 1.345, -0.008};
    const Vec3d elbow = shoulder + 0.28 * along_arm_, wrist = shoulder + 0.53 * along_arm_;
    const double limb =
        join(cone(p, shoulder, 0.052, elbow, 0.041), cone(p, elbow, 0.041, wrist, 0.028), 0.02);
    // The hand is flat and looks to the thigh.
    const Vec3d aside{-along_arm_.y / std::hypot(along_arm_.x, along_arm_.y),
                      along_arm_.x / std::hypot(along_arm_.x, along_arm_.y), 0};
    const Vec3d d = p - (wrist + 0.085 * along_arm_);
    const Vec3d in_hand{dot(d, aside), dot(d, along_arm_), dot(d, cross(aside, along_arm_))};
    return join(limb, ellipsoid(in_hand, {}, {0.024, 0.095, 0.043}), 0.02);
  }

  bool arms_;
  double size_;
  BodyTube torso_, leg_;
  Vec3d along_arm_;  ///< of length 1, of the arm at x > 0, from the shoulder
};

/// The person standing on the floor y = 0, looking to +z, left and right of x = 0, m. Takes about as many
/// microseconds as ten times the triangles, or a second of a debug build.
inline Surface body_with_arms(const PersonForm& form, const Person& person, double size) {
  const DistanceField field = person;
  // A cube that the surface passes through makes about eight triangles.
  const double cell = std::min(0.024, std::sqrt(1.8 * 8 / (1.2 * static_cast<double>(form.triangles))));
  const auto cells = [&](double extent) { return static_cast<std::uint32_t>(std::ceil(extent / cell)); };
  // The arms reach 0.71 m down from the shoulders, and a hand is 0.05 m wide.
  const auto reach = [&](double degrees) { return size * 0.8 * std::sin(degrees * std::numbers::pi / 180); };
  // x = 0 is a plane of corners: the legs never grow together there.
  const std::uint32_t aside = cells(0.3 + reach(form.arm_angle_degrees)), behind = cells(0.25),
                      before = cells(0.25 + reach(form.arm_forward_degrees));
  const FieldBox box{{-cell * aside, -2.3 * cell, -cell * behind},
                     cell,
                     {2 * aside, cells(1.72 * size) + 4, behind + before}};
  Surface surface = Decimation(isosurface(field, box), field).down_to(form.triangles);
  const double lowest = std::ranges::min(surface.points, {}, &Vec3d::y).y;
  for (Vec3d& point : surface.points) point.y -= lowest;
  return surface;
}

inline Surface body_with_arms(const PersonForm& form = {}) { return body_with_arms(form, Person(form), 1); }

/// As a scanner's file would have it.
inline Surface posed(Surface surface, const PersonPose& pose) {
  const double turn = pose.turn_degrees * std::numbers::pi / 180;
  for (Vec3d& point : surface.points) {
    point = {std::cos(turn) * point.x + std::sin(turn) * point.z, point.y,
             std::cos(turn) * point.z - std::sin(turn) * point.x};
    point += pose.shift;
    if (pose.z_up) point = {point.x, -point.z, point.y};
    point = 1 / pose.unit_m * point;
  }
  return surface;
}

}  // namespace mssim
