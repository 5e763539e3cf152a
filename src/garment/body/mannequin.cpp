#include "garment/body/mannequin.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "geometry/geometry.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

[[noreturn]] void fail(std::string_view measure, double value, std::string_view unit,
                       const std::string& rest) {
  throw InputError("the body's {} is {}{}{}", measure, shown(value), unit, rest);
}

void require_between(std::string_view measure, double value, std::string_view unit, double least,
                     double most) {
  // Negated so that NaN fails, too.
  if (!(value >= least && value <= most))
    fail(measure, value, unit,
         fmt::format("; give a number from {} to {}{}", shown(least), shown(most), unit));
}

/// Throws InputError if a height is not at least `apart` below the next, which a smooth body needs.
void require_below(std::string_view measure, double height, std::string_view next, double next_height,
                   double apart) {
  if (height > next_height - apart)
    fail(measure, height, " m",
         fmt::format(" and the {} is {} m; put it lower, at {} m at most, or the other higher", next,
                     shown(next_height), shown(next_height - apart)));
}

void require_heights_in_order(const BodyMeasures& m) {
  constexpr double apart = 0.02;
  constexpr double thigh_to_crotch = 0.005;
  require_below("ankle height", m.ankle.height, "knee height", m.knee.height, apart);
  require_below("knee height", m.knee.height, "thigh height", m.thigh.height, apart);
  require_below("thigh height", m.thigh.height, "crotch height", m.crotch_height, thigh_to_crotch);
  require_below("crotch height", m.crotch_height, "hip height", m.hip.height, apart);
  require_below("hip height", m.hip.height, "waist height", m.waist.height, apart);
  require_below("waist height", m.waist.height, "bust height", m.bust.height, apart);
}

void require_thighs_below_hip(const BodyMeasures& m) {
  const double hip_half_width = m.hip.girth / ellipse_perimeter(1, m.hip_aspect);
  const double room = 1.1 * hip_half_width - m.thigh_gap / 2;  // a tenth wider than the hip is still a body
  const double most = room / 2 * ellipse_perimeter(1, thigh_aspect);
  if (m.thigh.girth > most)
    fail("thigh girth", m.thigh.girth, " m",
         fmt::format(", and both thighs side by side would be wider than a hip with a girth of {} m; give a "
                     "thigh girth of at most {} m or a larger hip girth",
                     shown(m.hip.girth), shown(std::floor(most * 1000) / 1000)));
}

void check_measures(const BodyMeasures& m) {
  for (const auto& [name, at] : body_girths) {
    require_between(std::string(name) + " girth", (m.*at).girth, " m", 0.1, 3);
    require_between(std::string(name) + " height", (m.*at).height, " m", 0.03, 2.5);
  }
  require_between("crotch height", m.crotch_height, " m", 0.03, 2.5);
  require_between("hip aspect (depth over width)", m.hip_aspect, "", 0.5, 1);
  require_between("thigh gap", m.thigh_gap, " m", 0.004, 0.04);
  require_between("stance", m.stance, " m", 0.02, 1);
  require_heights_in_order(m);
  require_thighs_below_hip(m);
}

/// The longest straight distance between two sections along an edge of their boxes.
double way_between(const EllipseSection& a, const EllipseSection& b) {
  const double sideways = std::max({std::abs(b.x_min - a.x_min), std::abs(b.x_max - a.x_max),
                                    std::abs(b.z_min - a.z_min), std::abs(b.z_max - a.z_max)});
  const double up = b.height - a.height;
  return std::sqrt(sideways * sideways + up * up);
}

/// The sections, and rings between them for cells of about the wanted height, m.
std::vector<EllipseSection> interpolated(const std::vector<EllipseSection>& sections, double cell_height) {
  const auto curve = [&](double EllipseSection::*edge) -> MonotoneCurve {
    return {mapped<double>(sections, &EllipseSection::height), mapped<double>(sections, edge)};
  };
  const auto x_min = curve(&EllipseSection::x_min), x_max = curve(&EllipseSection::x_max);
  const auto z_min = curve(&EllipseSection::z_min), z_max = curve(&EllipseSection::z_max);
  std::vector<EllipseSection> rings{sections.front()};
  for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
    const EllipseSection& below = sections[i];
    const EllipseSection& above = sections[i + 1];
    const auto rows = static_cast<int>(std::ceil(way_between(below, above) / cell_height));
    for (int row = 1; row < rows; ++row) {
      const double y = below.height + (above.height - below.height) * row / rows;
      rings.push_back({y, x_min(y), x_max(y), z_min(y), z_max(y)});
    }
    rings.push_back(above);
  }
  return rings;
}

Vec3d centre(const EllipseSection& ring) {
  return {(ring.x_min + ring.x_max) / 2, ring.height, (ring.z_min + ring.z_max) / 2};
}

/// Adds the points of a ring in these directions from its centre.
void add_ring(Surface& surface, const EllipseSection& ring, const std::vector<Vec3d>& directions) {
  const double a = ring.half_width();
  const double b = ring.half_depth();
  const auto spoke = [&](std::size_t j) {
    const Vec3d& direction = directions[j % directions.size()];
    return Vec3d{a * direction.x, 0, b * direction.z};
  };
  double inscribed = 0;
  for (std::size_t j = 0; j < directions.size(); ++j) inscribed += length(spoke(j + 1) - spoke(j));
  const double larger = ellipse_perimeter(a, b) / inscribed;
  for (std::size_t j = 0; j < directions.size(); ++j)
    surface.points.push_back(rounded(centre(ring) + larger * spoke(j)));
}

/// Adds the cells between the ring of n points that starts at point `lower` and the next.
void add_belt(Surface& surface, std::uint32_t lower, std::uint32_t n) {
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t a = lower + j, b = lower + (j + 1) % n;
    const std::uint32_t c = a + n, d = b + n;
    // The diagonal alternates between quarters, so that the body is symmetric.
    if (4 * j / n % 2 == 0) {
      surface.triangles.push_back({a, c, b});
      surface.triangles.push_back({b, c, d});
    } else {
      surface.triangles.push_back({a, c, d});
      surface.triangles.push_back({a, d, b});
    }
  }
}

/// Closes the ring of n points that starts at point `ring`.
void add_end(Surface& surface, std::uint32_t ring, std::uint32_t n, const EllipseSection& section,
             bool is_top) {
  const auto middle = static_cast<std::uint32_t>(surface.points.size());
  surface.points.push_back(rounded(centre(section)));
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t a = ring + j, b = ring + (j + 1) % n;
    if (is_top)
      surface.triangles.push_back({middle, b, a});
    else
      surface.triangles.push_back({middle, a, b});
  }
}

double between(double from, double to, double fraction) { return from + (to - from) * fraction; }

/// Sections of the torso and of the leg at x > 0. Values that the measures do not give are in proportion to
/// the reference body's.
class Figure {
 public:
  explicit Figure(const BodyMeasures& measures) : m_(measures) {
    check_measures(m_);
    hip_ = section_of_girth(m_.hip.height, m_.hip.girth, m_.hip_aspect, 0, 0);
    thigh_axis_ = m_.thigh_gap / 2 + m_.thigh.girth / ellipse_perimeter(1, thigh_aspect);
  }

  std::vector<EllipseSection> torso() const {
    auto sections = mapped<EllipseSection>(seat, [&](const SeatPart& part) { return seat_section(part); });

    const double mid_girth = between(m_.waist.girth, m_.hip.girth, 0.58);
    const double mid_height = between(m_.hip.height, m_.waist.height, 0.5);
    sections.push_back(section_of_girth(mid_height, mid_girth, (m_.hip_aspect + waist_aspect) / 2, 0, 0));
    sections.push_back(section_of_girth(m_.waist.height, m_.waist.girth, waist_aspect, 0, 0.005));
    sections.push_back(section_of_girth(between(m_.waist.height, m_.bust.height, 0.46),
                                        between(m_.waist.girth, m_.bust.girth, 0.375), 0.75, 0, 0.004));
    sections.push_back(section_of_girth(m_.bust.height, m_.bust.girth, 0.72, 0, 0.006));

    // Shoulders and neck; heights above the bust are fractions of its height above the waist.
    const double rise = m_.bust.height - m_.waist.height;
    const auto above_bust = [&](double fraction, double girth, double aspect, double z) {
      sections.push_back(
          section_of_girth(m_.bust.height + fraction * rise, girth * m_.bust.girth, aspect, 0, z));
    };
    above_bust(0.22, 0.985, 0.62, 0.000);
    above_bust(0.37, 0.91, 0.51, -0.008);
    above_bust(0.47, 0.76, 0.48, -0.012);
    above_bust(0.55, 0.48, 0.70, -0.010);
    above_bust(0.64, 0.39, 0.92, -0.004);
    above_bust(0.85, 0.37, 1.0, 0.006);
    return sections;
  }

  std::vector<EllipseSection> leg() const {
    std::vector<EllipseSection> sections;
    const double foot_x = m_.stance / 2;
    const double foot_height = m_.ankle.height / 0.09;
    const double foot_size = m_.ankle.girth / 0.24;
    const auto foot = [&](double y, double half_width, double z_min, double z_max) {
      sections.push_back({y * foot_height, foot_x - half_width * foot_size, foot_x + half_width * foot_size,
                          z_min * foot_size, z_max * foot_size});
    };
    foot(0.000, 0.032, -0.050, 0.150);
    foot(0.006, 0.039, -0.057, 0.162);
    foot(0.020, 0.042, -0.060, 0.164);
    foot(0.040, 0.041, -0.058, 0.135);
    foot(0.060, 0.037, -0.053, 0.085);

    leg_section(sections, m_.ankle, 1.15, -0.002);
    const GirthAt& knee = m_.knee;
    const GirthAt& thigh = m_.thigh;
    leg_section(sections, {1.04 * m_.ankle.girth, between(m_.ankle.height, knee.height, 0.19)}, 1.05, -0.006);
    leg_section(sections, {0.97 * knee.girth, between(m_.ankle.height, knee.height, 0.65)}, 1.05, -0.012);
    leg_section(sections, knee, 1.05, 0);
    leg_section(sections, {between(knee.girth, thigh.girth, 0.63), between(knee.height, thigh.height, 0.533)},
                1.05, 0);
    leg_section(sections, thigh, thigh_aspect, -0.003);
    check_apart(sections);

    // From here on inside the torso, so that the legs' tops do not show.
    const EllipseSection hidden = within(seat_section(seat[4]), m_.thigh_gap / 2, 0.94, 0.78);
    EllipseSection entering = sections.back();
    entering.height = seat_section(seat[3]).height;
    entering.x_max = std::min(entering.x_max, hip_.x_max);
    sections.push_back(entering);
    sections.push_back(hidden);
    sections.push_back(within(seat_section({0.95, 1, 1}), 0.2 * hip_.x_max, 0.6, 0.3));
    return sections;
  }

 private:
  struct SeatPart {
    double fraction;      ///< of the way from the crotch up to the hip
    double width, depth;  ///< fractions of the hip's
  };
  /// Wide near the crotch, so that the outline has no dent between thighs and hip; deep only higher up, so
  /// that belly and seat do not hang over the thighs.
  static constexpr std::array<SeatPart, 6> seat{{{0, 0.45, 0.30},
                                                 {0.05, 0.70, 0.43},
                                                 {0.12, 0.83, 0.55},
                                                 {0.25, 0.94, 0.70},
                                                 {0.5, 0.985, 0.88},
                                                 {1, 1, 1}}};
  static constexpr double waist_aspect = 0.78;

  EllipseSection seat_section(const SeatPart& part) const {
    const double back = -0.044 * hip_.half_width() * part.fraction;
    return {between(m_.crotch_height, m_.hip.height, part.fraction), part.width * hip_.x_min,
            part.width * hip_.x_max, part.depth * hip_.z_min + back, part.depth * hip_.z_max + back};
  }

  /// A leg's ellipse within a torso's: from x_min to `width` of the torso's half width, and over `depth` of
  /// its depth. Up to a width of .94 and a depth of .78, it lies inside.
  static EllipseSection within(const EllipseSection& torso, double x_min, double width, double depth) {
    const double z = (torso.z_min + torso.z_max) / 2;
    return {torso.height, x_min, width * torso.x_max, between(z, torso.z_min, depth),
            between(z, torso.z_max, depth)};
  }

  /// The fraction of the way from the thigh's axis to the ankle's.
  double share_of_leg(double height) const {
    return (m_.thigh.height - height) / (m_.thigh.height - m_.ankle.height);
  }

  void leg_section(std::vector<EllipseSection>& sections, const GirthAt& at, double aspect, double z) const {
    const double x = between(thigh_axis_, m_.stance / 2, share_of_leg(at.height));
    sections.push_back(section_of_girth(at.height, at.girth, aspect, x, z));
  }

  /// A leg's inner edge is monotone between sections, so only sections are checked.
  void check_apart(const std::vector<EllipseSection>& leg) const {
    constexpr double least = 0.002;
    const auto nearest = std::ranges::min_element(leg, {}, &EllipseSection::x_min);
    if (nearest->x_min >= least) return;
    double needed = m_.stance;
    for (const EllipseSection& section : leg) {
      const double fraction = std::min(share_of_leg(section.height), 1.0);
      if (fraction > 0)
        needed =
            std::max(needed, 2 * (least + section.half_width() - (1 - fraction) * thigh_axis_) / fraction);
    }
    throw InputError(
        "the body's stance is {} m, and its legs would touch at the height {} m; give a stance of at least "
        "{} m or thinner legs",
        shown(m_.stance), shown(nearest->height), shown(std::ceil(needed * 1000) / 1000));
  }

  BodyMeasures m_;
  EllipseSection hip_;
  double thigh_axis_ = 0;  ///< x of the leg's middle at the thigh's height
};

/// The sections mirrored in x.
std::vector<EllipseSection> mirrored(std::vector<EllipseSection> sections) {
  for (EllipseSection& section : sections) {
    std::swap(section.x_min, section.x_max);
    section.x_min *= -1;
    section.x_max *= -1;
  }
  return sections;
}

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

void add_tube(Surface& surface, const std::vector<EllipseSection>& sections, std::uint32_t around,
              double cell_height) {
  assert(sections.size() >= 2 && around >= 4 && around % 4 == 0 && cell_height > 0);
  std::vector<Vec3d> directions;
  for (std::uint32_t j = 0; j < around; ++j) {
    const double angle = 2 * std::numbers::pi * j / around;
    directions.push_back({std::cos(angle), 0, std::sin(angle)});
  }
  const auto first = static_cast<std::uint32_t>(surface.points.size());
  for (const EllipseSection& ring : interpolated(sections, cell_height)) add_ring(surface, ring, directions);
  const auto last = static_cast<std::uint32_t>(surface.points.size()) - around;
  for (std::uint32_t ring = first; ring < last; ring += around) add_belt(surface, ring, around);
  add_end(surface, first, around, sections.front(), false);
  add_end(surface, last, around, sections.back(), true);
}

Surface mannequin(const BodyMeasures& measures, std::uint32_t cells_around) {
  if (cells_around < 16 || cells_around > 512 || cells_around % 4 != 0)
    throw InputError(
        "a mannequin cannot have {} points around its torso; give a multiple of four from 16 to 512",
        cells_around);
  const Figure figure(measures);
  const double cell = measures.hip.girth / cells_around;
  const std::uint32_t around_leg = 4 * ((cells_around + 3) / 6);
  Surface surface;
  add_tube(surface, figure.torso(), cells_around, cell);
  add_tube(surface, figure.leg(), around_leg, cell);
  add_tube(surface, mirrored(figure.leg()), around_leg, cell);
  return surface;
}

}  // namespace mssim
