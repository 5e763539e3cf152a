#include "garment/pattern/jeans_for_body.h"

#include <algorithm>
#include <cmath>

namespace mssim {
namespace {

double in_millimetres(double metres) { return std::round(1000 * metres) / 1000; }

/// What the jeans are wider than the body at their upper edge, m. Where the body hardly widens from there to
/// the hip, they hold by being narrower.
double ease_at_waist(const BodyProfile& profile, const JeansMeasures& jeans) {
  constexpr double usual = 0.01, least = -0.03;  // m
  constexpr double steep = 0.7;                  // m of girth per m of height: usual from there on
  constexpr double narrower = 0.1;               // m, by as much less for each m per m below
  const double widening = (profile.hull_girth(jeans.hip_height) - profile.hull_girth(jeans.waist_height)) /
                          (jeans.waist_height - jeans.hip_height);
  return std::clamp(usual + narrower * (widening - steep), least, usual);
}

/// How much the leg, straight from hem to knee, would have to be wider to go round the body's with some air.
double lack_of_width(const BodyProfile& profile, const JeansMeasures& jeans) {
  constexpr double air = 0.03, step = 0.01;  // m
  double lack = 0;
  for (double y = jeans.hem_height; y <= jeans.knee_height; y += step) {
    const double fraction = (y - jeans.hem_height) / (jeans.knee_height - jeans.hem_height);
    const double width = (1 - fraction) * jeans.hem + fraction * jeans.knee;
    lack = std::max(lack, thicker_leg(profile, y).value_or(0) + air - width);
  }
  return lack;
}

}  // namespace

JeansMeasures jeans_for_body(const BodyProfile& profile, const BodyLandmarks& body) {
  constexpr double edge = 0.8;                           // of the way from the hip to the waist
  constexpr double wider_knee = 1.135, wider_hem = 1.5;  // than knee and ankle
  JeansMeasures jeans;
  jeans.waist_height = in_millimetres(body.hip.height + edge * (body.waist.height - body.hip.height));
  jeans.hip_height = in_millimetres(body.hip.height);
  jeans.crotch_height = body.crotch_height;
  jeans.knee_height = in_millimetres(body.knee.height);
  jeans.hem_height = in_millimetres(std::max(body.ankle.height - 0.02, 0.03));
  if (body.knee.girth) jeans.knee = wider_knee * *body.knee.girth;
  if (body.ankle.girth) jeans.hem = wider_hem * *body.ankle.girth;
  const double lack = lack_of_width(profile, jeans);
  jeans.waist_ease = in_millimetres(ease_at_waist(profile, jeans));
  jeans.knee = in_millimetres(jeans.knee + lack);
  jeans.hem = in_millimetres(jeans.hem + lack);
  return jeans;
}

}  // namespace mssim
