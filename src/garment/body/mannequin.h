#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// A girth and the height at which it is taken, m.
struct GirthAt {
  double girth = 0;
  double height = 0;

  bool operator==(const GirthAt&) const = default;
};

/// What a mannequin is made from: girths as a tape measures them (around the convex hull of the section;
/// below the crotch around one leg), and how its legs stand. The body stands on the floor y = 0, looks to +z
/// and is its own mirror image in x. The defaults are the reference body, a figure of about 1.70 m.
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
  double stance = 0.25;          ///< m, from one ankle's middle to the other's

  bool operator==(const BodyMeasures&) const = default;
};

/// Depth over width of a thigh: no measure, but what its width follows from.
inline constexpr double thigh_aspect = 1.1;

/// A horizontal ellipse, given by the box around it, m. Tubes are interpolated edge by edge, so that none of
/// their sides overshoots.
struct EllipseSection {
  double height = 0;  ///< y
  double x_min = 0, x_max = 0;
  double z_min = 0, z_max = 0;

  double half_width() const { return (x_max - x_min) / 2; }
  double half_depth() const { return (z_max - z_min) / 2; }
};

/// The perimeter of an ellipse, m, after Ramanujan ("Modular equations and approximations to pi", 1914, his
/// second formula): right to a billionth where no axis is more than three times the other.
double ellipse_perimeter(double half_axis, double other_half_axis);

/// The ellipse of perimeter `girth` and of `aspect` = depth over width, centred at (x, height, z).
EllipseSection section_of_girth(double height, double girth, double aspect, double x, double z);

/// Adds to `surface` a closed tube through the sections, two or more from below upwards: smooth and monotone
/// between each two (MonotoneCurve), closed by flat ends, oriented outwards. Each section is a ring of its
/// own, of `around` points, a multiple of four; cells along the tube are about `cell_height` high, m, or
/// finer where sections ask for it. A ring is a polygon made larger by so much that its perimeter is the
/// ellipse's. The cut is its own mirror image in depth and in width.
void add_tube(Surface& surface, const std::vector<EllipseSection>& sections, std::uint32_t around,
              double cell_height);

/// A dress form with legs and feet: a torso and two legs, each a closed tube of elliptic sections that is
/// monotone between them; the legs' tops end inside the torso. The girths are the measures' at their heights,
/// whatever the resolution; from the hip upwards the torso is the whole section. The thighs meet nowhere:
/// below the crotch's height the body is two legs. Throws InputError that names measure, value and remedy for
/// measures that make no body (a number out of its range, heights that are not in order and a little apart,
/// thighs much wider than the hip), for legs that would touch, and for points around that are not
/// a multiple of four from 16 to 512. They go around the torso; a leg has about two thirds as many, and cells
/// are about square at the hip. 20 make 2,400 triangles of the reference body, 96 45,000, 128 79,000.
Surface mannequin(const BodyMeasures& measures, std::uint32_t cells_around = 96);

}  // namespace mssim
