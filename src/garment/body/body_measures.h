#pragma once

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

/// Throws InputError that names measure, value and remedy unless the measures make a body: every number in
/// its range, the heights in their order and a little apart, thighs not much wider than the hip.
void check_measures(const BodyMeasures& measures);

/// Depth over width of a thigh: no measure, but what its width follows from.
inline constexpr double thigh_aspect = 1.1;

}  // namespace mssim
