#include "garment/body/body_measures.h"

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "garment/body/ellipse_tube.h"
#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

struct NamedGirth {
  std::string_view name;
  GirthAt at;
};

[[noreturn]] void fail(std::string_view measure, double value, std::string_view unit,
                       const std::string& rest) {
  throw InputError("the body's " + std::string(measure) + " is " + shown(value) + std::string(unit) + rest);
}

void require_between(std::string_view measure, double value, std::string_view unit, double least,
                     double most) {
  // Written so that what is no number fails too.
  if (!(value >= least && value <= most))
    fail(measure, value, unit,
         "; give a number from " + shown(least) + " to " + shown(most) + std::string(unit));
}

/// Heights closer together than this leave no room for a smooth body between them.
void require_below(std::string_view measure, double height, std::string_view next, double next_height,
                   double apart) {
  if (height > next_height - apart)
    fail(measure, height, " m",
         " and the " + std::string(next) + " is " + shown(next_height) + " m; put it lower, at " +
             shown(next_height - apart) + " m at most, or the other higher");
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
         ", and both thighs side by side would stick out beyond a hip girth of " + shown(m.hip.girth) +
             " m; give a thigh girth of at most " + shown(std::floor(most * 1000) / 1000) +
             " m or a larger hip girth");
}

}  // namespace

void check_measures(const BodyMeasures& m) {
  const std::array girths{NamedGirth{"bust", m.bust}, NamedGirth{"waist", m.waist},
                          NamedGirth{"hip", m.hip},   NamedGirth{"thigh", m.thigh},
                          NamedGirth{"knee", m.knee}, NamedGirth{"ankle", m.ankle}};
  for (const NamedGirth& girth : girths) {
    require_between(std::string(girth.name) + " girth", girth.at.girth, " m", 0.1, 3);
    require_between(std::string(girth.name) + " height", girth.at.height, " m", 0.03, 2.5);
  }
  require_between("crotch height", m.crotch_height, " m", 0.03, 2.5);
  require_between("hip aspect (depth over width)", m.hip_aspect, "", 0.5, 1);
  require_between("thigh gap", m.thigh_gap, " m", 0.004, 0.04);
  require_between("stance", m.stance, " m", 0.02, 1);
  require_heights_in_order(m);
  require_thighs_below_hip(m);
}

}  // namespace mssim
