#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <istream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/geometry.h"
#include "tests/support/body_with_arms.h"

namespace mssim {

/// A person of tests/support/persons.csv, m; its columns have these names and end in "_m". From width, depth
/// and girth follows by how much a section is no ellipse.
struct PersonMeasures {
  std::string name;
  bool arms = false;
  double stature = 0, chest = 0, waist_height = 0, waist = 0, waist_width = 0, waist_depth = 0,
         navel_height = 0, navel = 0, hip_height = 0, hip = 0, hip_width = 0, hip_depth = 0,
         crotch_height = 0, thigh = 0, knee_height = 0, knee = 0, calf = 0, ankle = 0;
};

/// The table's persons in its order. Throws std::runtime_error for a table that is none.
inline std::vector<PersonMeasures> read_persons(std::istream& table) {
  constexpr std::array<double PersonMeasures::*, 18> lengths{
      &PersonMeasures::stature,       &PersonMeasures::chest,       &PersonMeasures::waist_height,
      &PersonMeasures::waist,         &PersonMeasures::waist_width, &PersonMeasures::waist_depth,
      &PersonMeasures::navel_height,  &PersonMeasures::navel,       &PersonMeasures::hip_height,
      &PersonMeasures::hip,           &PersonMeasures::hip_width,   &PersonMeasures::hip_depth,
      &PersonMeasures::crotch_height, &PersonMeasures::thigh,       &PersonMeasures::knee_height,
      &PersonMeasures::knee,          &PersonMeasures::calf,        &PersonMeasures::ankle};
  std::vector<PersonMeasures> persons;
  std::string line;
  bool past_header = false;
  while (std::getline(table, line)) {
    if (line.empty() || line.front() == '#') continue;
    if (!std::exchange(past_header, true)) continue;
    std::istringstream cells(line);
    std::string cell;
    PersonMeasures person;
    std::getline(cells, person.name, ',');
    std::getline(cells, cell, ',');  // the source
    std::getline(cells, cell, ',');  // percentiles
    std::getline(cells, cell, ',');
    person.arms = cell == "A-pose";
    for (const auto length : lengths) {
      std::getline(cells, cell, ',');
      person.*length = std::stod(cell);
    }
    persons.push_back(person);
  }
  return persons;
}

/// What a person's surface is made of: trunk and leg, each from below upwards, and the rest for a body of
/// 1.70 m, `size` times as large.
class MeasuredFigure {
 public:
  explicit MeasuredFigure(const PersonMeasures& measures) : m_(measures) {
    m_.hip_height = std::max(m_.hip_height, m_.crotch_height + 0.045);
    hip_ = of_girth({.height = m_.hip_height,
                     .half_width = m_.hip_width / 2,
                     .front = (1 - seat_share) * m_.hip_depth,
                     .back = seat_share * m_.hip_depth},
                    m_.hip);
    waist_ = of_girth(waist_at(m_.waist_height), m_.waist);
    navel_ = of_girth(waist_at(m_.navel_height), m_.navel);
  }

  PersonParts parts() const { return {torso(), leg(), m_.stature / 1.70}; }

 private:
  /// Of the hip's depth, what lies behind the middle of the legs.
  static constexpr double seat_share = 0.55;

  /// The loins lie before the seat.
  BodySection waist_at(double height) const {
    const double hollow = m_.name.starts_with("man") ? 0.14 : 0.20;  // of the hip's depth
    const double back = (seat_share - hollow) * m_.hip_depth;
    return {.height = height, .half_width = m_.waist_width / 2, .front = m_.waist_depth - back, .back = back};
  }

  static double girth_of(const BodySection& section) {
    std::vector<PlanPoint> points;
    constexpr int around = 180;
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const double c = std::cos(angle), s = std::sin(angle);
      const double power = s > 0 ? section.front_power : section.back_power;
      const double depth = s > 0 ? section.front : section.back;
      const auto on_side = [&](double along) {
        return std::copysign(std::pow(std::abs(along), 2 / power), along);
      };
      points.push_back({section.half_width * on_side(c), depth * on_side(s)});
    }
    return hull_perimeter(points);
  }

  /// The section with the powers, flatter behind than before, of which its width and depth have the girth;
  /// where none have, of powers that people have, and scaled.
  static BodySection of_girth(BodySection section, double girth) {
    double least = 2.0, most = 3.4;
    const auto with = [&](double power) {
      section.front_power = power - 0.2;
      section.back_power = power + 0.4;
      return section;
    };
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = (least + most) / 2;
      (girth_of(with(middle)) < girth ? least : most) = middle;
    }
    section = with(most);
    return scaled(section, girth / girth_of(section));
  }

  static BodySection scaled(BodySection section, double factor) {
    section.half_width *= factor;
    section.front *= factor;
    section.back *= factor;
    return section;
  }

  std::vector<BodySection> torso() const {
    std::vector<BodySection> sections;
    // Up from the crotch, wide early and deep late.
    constexpr double rounding = 0.006;  // by which what is joined to the legs is lower
    const auto seat = [&](double fraction, double width, double depth) {
      BodySection section = hip_;
      section.height = m_.crotch_height + rounding + fraction * (m_.hip_height - m_.crotch_height - rounding);
      section.half_width *= width;
      section.front *= depth;
      section.back *= depth;
      sections.push_back(section);
    };
    seat(0, 0.45, 0.30);
    seat(0.05, 0.70, 0.43);
    seat(0.12, 0.83, 0.55);
    seat(0.25, 0.94, 0.70);
    seat(0.5, 0.985, 0.88);
    sections.push_back(hip_);
    if (m_.navel_height < m_.waist_height) sections.push_back(navel_);
    sections.push_back(waist_);
    const auto above = [&](double height, double girth, double aspect, double z) {
      const double width = girth / ellipse_perimeter(1, aspect);
      sections.push_back({.height = height * m_.stature,
                          .half_width = width,
                          .z = z,
                          .front = aspect * width,
                          .back = aspect * width});
    };
    above(0.725, m_.chest, 0.74, 0.006);
    above(0.788, 0.9 * m_.chest, 0.56, 0);
    above(0.815, 0.80 * m_.chest, 0.42, -0.010);
    above(0.832, 0.34 * m_.stature, 0.60, -0.012);
    above(0.850, 0.225 * m_.stature, 0.92, -0.006);
    above(0.918, 0.20 * m_.stature, 1.0, 0.004);
    return sections;
  }

  std::vector<BodySection> leg() const {
    constexpr double gap = 0.012;   // between the thighs
    constexpr double below = 0.02;  // the crotch, where the thigh is measured
    const double thigh_height = m_.crotch_height - below;
    // No wider than the hip has room for: thighs are deeper than wide where they are full.
    double half_width =
        std::min(m_.thigh / ellipse_perimeter(1, thigh_aspect), (hip_.half_width - gap / 2) / 2);
    double aspect = thigh_aspect;
    while (half_width * ellipse_perimeter(1, aspect) < m_.thigh) aspect += 0.002;
    const double top = gap / 2 + half_width, ankle_height = 0.07 * m_.stature;
    const double stance = std::max(0.075 * m_.stature, top + 0.01);
    std::vector<BodySection> sections;
    const auto section = [&](double height, double girth, double depth_over_width, double z) {
      const double share = (thigh_height - height) / (thigh_height - ankle_height);
      const double width = girth / ellipse_perimeter(1, depth_over_width);
      sections.push_back({.height = height,
                          .x = top + share * (stance - top),
                          .half_width = width,
                          .z = z,
                          .front = depth_over_width * width,
                          .back = depth_over_width * width});
    };
    section(0.03, 1.05 * m_.ankle, 1.2, 0);
    section(ankle_height, m_.ankle, 1.15, -0.002);
    section(ankle_height + 0.25 * (m_.knee_height - ankle_height), 0.35 * m_.calf + 0.65 * m_.ankle, 1.05,
            -0.008);
    section(ankle_height + 0.62 * (m_.knee_height - ankle_height), m_.calf, 1.05, -0.014);
    section(m_.knee_height, m_.knee, 1.05, 0);
    section(m_.knee_height + 0.5 * (thigh_height - m_.knee_height), 0.42 * m_.knee + 0.58 * m_.thigh,
            (1.05 + aspect) / 2, 0);
    section(thigh_height, m_.thigh, aspect, 0);
    // From here on within the trunk.
    const auto within = [&](double height, double width, double depth) {
      const double outer = width * hip_.half_width, inner = 0.1 * hip_.half_width;
      sections.push_back({.height = height,
                          .x = (inner + outer) / 2,
                          .half_width = (outer - inner) / 2,
                          .front = depth * m_.hip_depth / 2,
                          .back = depth * m_.hip_depth / 2});
    };
    within(m_.hip_height, 0.85, 0.7);
    within(m_.hip_height + 0.06, 0.7, 0.4);
    return sections;
  }

  PersonMeasures m_;
  BodySection hip_, waist_, navel_;
};

/// The person, standing on the floor y = 0, looking to +z; arms 30 degrees from the vertical, or none.
inline Surface measured_person(const PersonMeasures& measures, std::size_t triangles = 20'000) {
  const PersonForm form{.triangles = triangles, .arms = measures.arms, .arm_angle_degrees = 30};
  const PersonParts parts = MeasuredFigure(measures).parts();
  return body_with_arms(form, Person(form, parts), parts.size);
}

}  // namespace mssim
