#include "garment/body/mannequin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "garment/body/ellipse_tube.h"
#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

double between(double from, double to, double fraction) { return from + (to - from) * fraction; }

/// Sections of the torso and of the leg at x > 0. What the measures do not say is in proportion to the
/// reference body's.
class Figure {
 public:
  explicit Figure(const BodyMeasures& measures) : m_(measures) {
    check_measures(m_);
    hip_ = section_of_girth(m_.hip.height, m_.hip.girth, m_.hip_aspect, 0, 0);
    thigh_axis_ = m_.thigh_gap / 2 + m_.thigh.girth / ellipse_perimeter(1, thigh_aspect);
  }

  std::vector<EllipseSection> torso() const {
    std::vector<EllipseSection> sections;
    for (const SeatPart& part : seat) sections.push_back(seat_section(part));

    const double mid_girth = between(m_.waist.girth, m_.hip.girth, 0.58);
    const double mid_height = between(m_.hip.height, m_.waist.height, 0.5);
    sections.push_back(section_of_girth(mid_height, mid_girth, (m_.hip_aspect + waist_aspect) / 2, 0, 0));
    sections.push_back(section_of_girth(m_.waist.height, m_.waist.girth, waist_aspect, 0, 0.005));
    sections.push_back(section_of_girth(between(m_.waist.height, m_.bust.height, 0.46),
                                        between(m_.waist.girth, m_.bust.girth, 0.375), 0.75, 0, 0.004));
    sections.push_back(section_of_girth(m_.bust.height, m_.bust.girth, 0.72, 0, 0.006));

    // Shoulders and neck, above the bust in shares of its height above the waist.
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

    // From here on inside the torso, so that nothing of the legs' tops shows.
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
    double width, depth;  ///< of the hip's
  };
  /// Wide early, so that the outline runs from the thighs into the hip without a dent; deep late, so that
  /// belly and seat do not hang over the thighs.
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

  /// A leg's ellipse within a torso's: it reaches from x_min to `width` of the torso's half width, in depth
  /// over `depth` of it. Up to a width of .94 and a depth of .78 no point of it lies outside.
  static EllipseSection within(const EllipseSection& torso, double x_min, double width, double depth) {
    const double z = (torso.z_min + torso.z_max) / 2;
    return {torso.height, x_min, width * torso.x_max, between(z, torso.z_min, depth),
            between(z, torso.z_max, depth)};
  }

  /// The share of the way from the thigh's axis to the ankle's.
  double share_of_leg(double height) const {
    return (m_.thigh.height - height) / (m_.thigh.height - m_.ankle.height);
  }

  void leg_section(std::vector<EllipseSection>& sections, const GirthAt& at, double aspect, double z) const {
    const double x = between(thigh_axis_, m_.stance / 2, share_of_leg(at.height));
    sections.push_back(section_of_girth(at.height, at.girth, aspect, x, z));
  }

  /// Between the sections a leg's inner edge is monotone, so they are all there is to look at.
  void check_apart(const std::vector<EllipseSection>& leg) const {
    constexpr double least = 0.002;
    const auto nearest = std::min_element(leg.begin(), leg.end(),
                                          [](const auto& a, const auto& b) { return a.x_min < b.x_min; });
    if (nearest->x_min >= least) return;
    double needed = m_.stance;
    for (const EllipseSection& section : leg) {
      const double fraction = std::min(share_of_leg(section.height), 1.0);
      if (fraction > 0)
        needed =
            std::max(needed, 2 * (least + section.half_width() - (1 - fraction) * thigh_axis_) / fraction);
    }
    throw InputError("the body's stance is " + shown(m_.stance) +
                     " m, and its legs would touch at the height " + shown(nearest->height) +
                     " m; give a stance of at least " + shown(std::ceil(needed * 1000) / 1000) +
                     " m or thinner legs");
  }

  BodyMeasures m_;
  EllipseSection hip_;
  double thigh_axis_ = 0;  ///< x of the leg's middle at the thigh's height
};

/// The mirror image in x.
std::vector<EllipseSection> mirrored(std::vector<EllipseSection> sections) {
  for (EllipseSection& section : sections) {
    std::swap(section.x_min, section.x_max);
    section.x_min *= -1;
    section.x_max *= -1;
  }
  return sections;
}

}  // namespace

Surface mannequin(const BodyMeasures& measures, const MannequinResolution& resolution) {
  const std::uint32_t around = resolution.cells_around;
  if (around < 16 || around > 512 || around % 4 != 0)
    throw InputError("the points around a mannequin are " + std::to_string(around) +
                     "; give a multiple of four from 16 to 512");
  const Figure figure(measures);
  const double cell = measures.hip.girth / around;
  const std::uint32_t around_leg = 4 * ((around + 3) / 6);
  Surface surface;
  add_tube(surface, figure.torso(), {around, cell});
  add_tube(surface, figure.leg(), {around_leg, cell});
  add_tube(surface, mirrored(figure.leg()), {around_leg, cell});
  return surface;
}

}  // namespace mssim
