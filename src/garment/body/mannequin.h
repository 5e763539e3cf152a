#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// A girth and the height at which it is measured, m.
struct GirthAt {
  double girth = 0;
  double height = 0;

  bool operator==(const GirthAt&) const = default;
};

/// Measures of a mannequin: girths as a tape measures them (around the convex hull of the section, below the
/// crotch around one leg), and the stance of its legs. The body stands on the floor y = 0, faces +z and is
/// symmetric in x. The defaults are the reference body, a figure of about 1.70 m.
struct BodyMeasures {
  GirthAt bust{0.90, 1.28};
  GirthAt waist{0.74, 1.04};
  GirthAt hip{0.98, 0.86};
  GirthAt thigh{0.56, 0.76};
  GirthAt knee{0.37, 0.46};
  GirthAt ankle{0.24, 0.09};
  double crotch_height = 0.768;  ///< m
  double hip_aspect = 0.72;      ///< depth of the hip over its width
  double thigh_gap = 0.01;       ///< m, between the thighs at the thigh's height; it widens below
  double stance = 0.25;          ///< m, between the middles of the ankles

  bool operator==(const BodyMeasures&) const = default;
};

/// The names of its girths, from the top down.
inline constexpr std::array body_girths{
    std::pair{"bust", &BodyMeasures::bust}, std::pair{"waist", &BodyMeasures::waist},
    std::pair{"hip", &BodyMeasures::hip},   std::pair{"thigh", &BodyMeasures::thigh},
    std::pair{"knee", &BodyMeasures::knee}, std::pair{"ankle", &BodyMeasures::ankle}};

/// Depth over width of a thigh: a constant from which its width follows.
inline constexpr double thigh_aspect = 1.1;

/// A horizontal ellipse, given by its bounding box, m. Tubes interpolate each edge of the boxes, so that no
/// side overshoots.
struct EllipseSection {
  double height = 0;  ///< y
  double x_min = 0, x_max = 0;
  double z_min = 0, z_max = 0;

  double half_width() const { return (x_max - x_min) / 2; }
  double half_depth() const { return (z_max - z_min) / 2; }
};

/// The perimeter of an ellipse, m, after Ramanujan ("Modular equations and approximations to pi", 1914,
/// second formula): accurate to 1e-9 if no axis is more than three times the other.
double ellipse_perimeter(double half_axis, double other_half_axis);

/// The ellipse of perimeter `girth` and of `aspect` = depth over width, centred at (x, height, z).
EllipseSection section_of_girth(double height, double girth, double aspect, double x, double z);

/// Adds to `surface` a closed tube through two or more sections, bottom up: smooth and monotone between
/// sections (MonotoneCurve), closed by flat ends, oriented outwards. Each section is a ring of `around`
/// points, a multiple of four. Cells along the tube are about `cell_height` high, m, or finer if sections are
/// closer. The polygon of a ring is enlarged until its perimeter is the ellipse's. The triangulation is
/// symmetric in depth and width.
void add_tube(Surface& surface, const std::vector<EllipseSection>& sections, std::uint32_t around,
              double cell_height);

/// A dress form with legs and feet: a torso and two legs, each a closed tube of elliptic sections that is
/// monotone between them; the legs' tops end inside the torso. At the heights of the measures, the girths
/// equal the measures at any resolution; from the hip upwards, the section is the torso only. The thighs do
/// not touch: below the crotch the body is two legs. `cells_around` is the number of points around the torso;
/// a leg has about two thirds as many, and cells are about square at the hip. 20 points give 2,400 triangles
/// for the reference body, 96 give 45,000, 128 give 79,000. Throws InputError, which names measure, value and
/// remedy, for a number out of range, heights out of order or too close, thighs much wider than the hip, legs
/// that would touch, and `cells_around` that is not a multiple of four from 16 to 512.
Surface mannequin(const BodyMeasures& measures, std::uint32_t cells_around = 96);

}  // namespace mssim
