#include "garment/body/ellipse_tube.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "geometry/geometry.h"

namespace mssim {
namespace {

class Tube {
 public:
  Tube(Surface& surface, const std::vector<EllipseSection>& sections, const TubeCells& cells)
      : surface_(surface), sections_(sections), cells_(cells) {
    for (std::uint32_t j = 0; j < cells.around; ++j) {
      const double angle = 2 * std::numbers::pi * j / cells.around;
      directions_.push_back({std::cos(angle), 0, std::sin(angle)});
    }
  }

  void add() {
    const std::vector<EllipseSection> rings = interpolated();
    const auto first = static_cast<std::uint32_t>(surface_.points.size());
    for (const EllipseSection& ring : rings) add_ring(ring);
    const auto last = static_cast<std::uint32_t>(surface_.points.size()) - cells_.around;
    for (std::uint32_t ring = first; ring < last; ring += cells_.around) add_belt(ring);
    add_end(first, sections_.front(), false);
    add_end(last, sections_.back(), true);
  }

 private:
  MonotoneCurve curve(double EllipseSection::*edge) const {
    std::vector<double> heights, values;
    for (const EllipseSection& section : sections_) {
      heights.push_back(section.height);
      values.push_back(section.*edge);
    }
    return {heights, values};
  }

  /// The sections, and between each two as many more as cells of about the wanted height need.
  std::vector<EllipseSection> interpolated() const {
    const auto x_min = curve(&EllipseSection::x_min), x_max = curve(&EllipseSection::x_max);
    const auto z_min = curve(&EllipseSection::z_min), z_max = curve(&EllipseSection::z_max);
    std::vector<EllipseSection> rings{sections_.front()};
    for (std::size_t i = 0; i + 1 < sections_.size(); ++i) {
      const EllipseSection& below = sections_[i];
      const EllipseSection& above = sections_[i + 1];
      const auto rows = static_cast<int>(std::ceil(way_between(below, above) / cells_.height));
      for (int row = 1; row < rows; ++row) {
        const double y = below.height + (above.height - below.height) * row / rows;
        rings.push_back({y, x_min(y), x_max(y), z_min(y), z_max(y)});
      }
      rings.push_back(above);
    }
    return rings;
  }

  /// The longest straight way from one section to the next along an edge of their boxes.
  static double way_between(const EllipseSection& a, const EllipseSection& b) {
    const double sideways = std::max({std::abs(b.x_min - a.x_min), std::abs(b.x_max - a.x_max),
                                      std::abs(b.z_min - a.z_min), std::abs(b.z_max - a.z_max)});
    const double up = b.height - a.height;
    return std::sqrt(sideways * sideways + up * up);
  }

  static Vec3d centre(const EllipseSection& ring) {
    return {(ring.x_min + ring.x_max) / 2, ring.height, (ring.z_min + ring.z_max) / 2};
  }

  void add_ring(const EllipseSection& ring) {
    const double a = ring.half_width();
    const double b = ring.half_depth();
    const auto spoke = [&](std::size_t j) {
      const Vec3d& direction = directions_[j % directions_.size()];
      return Vec3d{a * direction.x, 0, b * direction.z};
    };
    double inscribed = 0;
    for (std::size_t j = 0; j < directions_.size(); ++j) inscribed += length(spoke(j + 1) - spoke(j));
    const double larger = ellipse_perimeter(a, b) / inscribed;
    for (std::size_t j = 0; j < directions_.size(); ++j)
      surface_.points.push_back(rounded(centre(ring) + larger * spoke(j)));
  }

  /// The cells between the ring that begins at point `lower` and the next.
  void add_belt(std::uint32_t lower) {
    const std::uint32_t n = cells_.around;
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = lower + j, b = lower + (j + 1) % n;
      const std::uint32_t c = a + n, d = b + n;
      // Quarter by quarter the other diagonal, so that no side of the body differs from its mirror image.
      if (4 * j / n % 2 == 0) {
        surface_.triangles.push_back({a, c, b});
        surface_.triangles.push_back({b, c, d});
      } else {
        surface_.triangles.push_back({a, c, d});
        surface_.triangles.push_back({a, d, b});
      }
    }
  }

  void add_end(std::uint32_t ring, const EllipseSection& section, bool is_top) {
    const auto middle = static_cast<std::uint32_t>(surface_.points.size());
    surface_.points.push_back(rounded(centre(section)));
    for (std::uint32_t j = 0; j < cells_.around; ++j) {
      const std::uint32_t a = ring + j, b = ring + (j + 1) % cells_.around;
      if (is_top)
        surface_.triangles.push_back({middle, b, a});
      else
        surface_.triangles.push_back({middle, a, b});
    }
  }

  Surface& surface_;
  const std::vector<EllipseSection>& sections_;
  const TubeCells cells_;
  std::vector<Vec3d> directions_;  ///< of a ring's points
};

}  // namespace

double ellipse_perimeter(double half_axis, double other_half_axis) {
  const double sum = half_axis + other_half_axis;
  const double difference = half_axis - other_half_axis;
  const double h = difference * difference / (sum * sum);
  return std::numbers::pi * sum * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h)));
}

EllipseSection section_of_girth(double height, double girth, double aspect, double x, double z) {
  const double half_width = girth / ellipse_perimeter(1, aspect);
  const double half_depth = half_width * aspect;
  return {height, x - half_width, x + half_width, z - half_depth, z + half_depth};
}

void add_tube(Surface& surface, const std::vector<EllipseSection>& sections, const TubeCells& cells) {
  assert(sections.size() >= 2 && cells.around >= 4 && cells.around % 4 == 0 && cells.height > 0);
  Tube(surface, sections, cells).add();
}

}  // namespace mssim
