#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

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

/// How finely a tube is cut.
struct TubeCells {
  std::uint32_t around = 0;  ///< points of a ring, a multiple of four
  double height = 0;  ///< m, about that of a cell along the tube; the cut is finer where sections ask for it
};

/// Adds to `surface` a closed tube through the sections, two or more from below upwards: smooth and monotone
/// between each two (MonotoneCurve), closed by flat ends, oriented outwards. Each section is a ring of its
/// own. A ring is a polygon made larger by so much that its perimeter is the ellipse's. The cut is its own
/// mirror image in depth and in width.
void add_tube(Surface& surface, const std::vector<EllipseSection>& sections, const TubeCells& cells);

}  // namespace mssim
