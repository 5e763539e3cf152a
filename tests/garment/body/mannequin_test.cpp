#include "garment/body/mannequin.h"

#include "garment/body/body_profile.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

/// The reference body with another hip; waist and thigh along with it.
BodyMeasures with_hip(double girth) {
  BodyMeasures measures;
  const double factor = girth / measures.hip.girth;
  measures.hip.girth *= factor;
  measures.waist.girth *= factor;
  measures.thigh.girth *= factor;
  return measures;
}

/// The parts of a mannequin: the torso comes first, and each leg begins on the floor.
std::vector<Surface> parts_of(const Surface& body) {
  std::vector<std::uint32_t> begin{0};
  // A part's last two points are the middles of its ends; the lower one's alone is no ring.
  const auto on_floor = [&](std::uint32_t p) { return body.points[p].y == 0; };
  for (std::uint32_t p = 1; p + 1 < body.points.size(); ++p)
    if (!on_floor(p - 1) && on_floor(p) && on_floor(p + 1)) begin.push_back(p);
  begin.push_back(static_cast<std::uint32_t>(body.points.size()));
  std::vector<Surface> parts;
  for (std::size_t i = 0; i + 1 < begin.size(); ++i) {
    Surface part{{body.points.begin() + begin[i], body.points.begin() + begin[i + 1]}, {}};
    for (const auto& [a, b, c] : body.triangles)
      if (a >= begin[i] && a < begin[i + 1])
        part.triangles.push_back({a - begin[i], b - begin[i], c - begin[i]});
    parts.push_back(part);
  }
  return parts;
}

void expect_measures(const BodyProfile& profile, const BodyMeasures& measures) {
  constexpr double relative = 1e-4;
  for (const GirthAt& at : {measures.bust, measures.waist, measures.hip})
    EXPECT_NEAR(profile.hull_girth(at.height), at.girth, relative * at.girth) << at.height;
  for (const GirthAt& at : {measures.thigh, measures.knee, measures.ankle})
    for (const int side : {-1, 1})
      EXPECT_NEAR(profile.leg_girth(at.height, side), at.girth, relative * at.girth) << at.height;
  EXPECT_NEAR(profile.crotch_height(), measures.crotch_height, 1e-6);
  EXPECT_EQ(profile.lowest(), 0);
}

TEST(Ellipse, ThePerimeterIsTheEllipticIntegral) {
  for (const double b : {0.35, 0.5, 0.72, 1.0})
    EXPECT_NEAR(ellipse_perimeter(b, 1), 4 * std::comp_ellint_2(std::sqrt(1 - b * b)), 1e-7) << b;
}

TEST(Mannequin, HasItsMeasuresAtEveryResolutionAndSize) {
  for (const double hip : {0.88, 0.98, 1.15})
    for (const std::uint32_t cells_around : {16U, 20U, 96U}) {
      SCOPED_TRACE(testing::Message() << "hip " << hip << ", " << cells_around << " around");
      expect_measures(BodyProfile(mannequin(with_hip(hip), cells_around)), with_hip(hip));
    }
}

TEST(Mannequin, OtherMeasuresAreKeptToo) {
  BodyMeasures measures;
  measures.bust = {1.05, 1.40};
  measures.waist = {0.95, 1.13};
  measures.hip = {1.02, 0.95};
  measures.thigh = {0.52, 0.82};
  measures.knee = {0.40, 0.52};
  measures.ankle = {0.26, 0.10};
  measures.crotch_height = 0.83;
  measures.hip_aspect = 0.8;
  measures.thigh_gap = 0.04;
  measures.stance = 0.3;
  const Surface body = mannequin(measures);
  const BodyProfile profile(body);
  expect_measures(profile, measures);
  EXPECT_NEAR(profile.front(0.95) - profile.back(0.95), 0.8 * 2 * profile.half_width(0.95), 1e-5);
  double left = 1, right = -1;
  for (const Vec3d& point : body.points)
    if (point.y == 0.10 && point.x > 0) {
      left = std::min(left, point.x);
      right = std::max(right, point.x);
    }
  EXPECT_NEAR((left + right) / 2, 0.15, 1e-6);
}

TEST(Mannequin, EachPartIsClosedAndOrientedOutwards) {
  for (const std::uint32_t cells_around : {16U, 36U, 96U, 256U}) {
    const std::vector<Surface> parts = parts_of(mannequin({}, cells_around));
    ASSERT_EQ(parts.size(), 3U);
    for (const Surface& part : parts) EXPECT_NO_THROW(validate_surface(part, "part"));
  }
}

TEST(Mannequin, TheLegsNeverTouch) {
  for (const double hip : {0.88, 0.98, 1.05, 1.15}) {
    const BodyMeasures measures = with_hip(hip);
    const Surface body = mannequin(measures, 32);
    const std::vector<Surface> parts = parts_of(body);
    for (const Vec3d& point : parts[1].points) EXPECT_GT(point.x, 0.004) << hip << " " << point.y;
    for (const Vec3d& point : parts[2].points) EXPECT_LT(point.x, -0.004) << hip << " " << point.y;
    const BodyProfile profile(body);
    for (double y = 0; y < measures.crotch_height; y += 0.0119)
      EXPECT_NEAR(profile.leg_girth(y, -1), profile.leg_girth(y, 1), 1e-5) << hip << " " << y;
  }
}

TEST(Mannequin, TheLegsTopsStayInsideTheTorso) {
  for (const double hip : {0.88, 0.98, 1.15})
    for (const double gap : {0.004, 0.01, 0.04}) {
      BodyMeasures measures = with_hip(hip);
      measures.thigh_gap = gap;
      measures.thigh.girth *= 0.95;
      const Surface body = mannequin(measures, 48);
      const BodyProfile whole(body);
      const BodyProfile torso(parts_of(body)[0]);
      // From halfway between crotch and hip on, the legs add nothing to the torso's convex section.
      for (double y = 0.8141; y < 1; y += 0.0053)
        EXPECT_NEAR(whole.hull_girth(y), torso.hull_girth(y), 1e-9) << hip << " " << gap << " " << y;
    }
}

TEST(Mannequin, TheOutlineRunsFromTheThighIntoTheHipWithoutADent) {
  const BodyProfile profile(mannequin({}));
  double widest = 0;
  for (double y = 0.76; y <= 0.86; y += 0.002) {
    EXPECT_GT(profile.half_width(y), widest - 0.002) << y;
    widest = std::max(widest, profile.half_width(y));
  }
}

TEST(Mannequin, MeasuresThatMakeNoBodyAreNamed) {
  struct Spoiled {
    double& (*of)(BodyMeasures& m);
    double value;
    const char* says;
  };
  const Spoiled all[]{
      {[](auto& m) -> double& { return m.waist.girth; }, 0,
       "the body's waist girth is 0 m; give a number from 0.1 to 3 m"},
      {[](auto& m) -> double& { return m.crotch_height; }, std::nan(""), "crotch height is nan m"},
      {[](auto& m) -> double& { return m.hip_aspect; }, 0, "hip aspect (depth over width) is 0;"},
      {[](auto& m) -> double& { return m.thigh_gap; }, 0, "thigh gap is 0 m"},
      {[](auto& m) -> double& { return m.stance; }, -1, "stance is -1 m"},
      {[](auto& m) -> double& { return m.waist.height; }, 1.3,
       "waist height is 1.3 m and the bust height is 1.28 m; put it lower"},
      {[](auto& m) -> double& { return m.waist.height; }, 1.3, "1.26 m at most"},
      {[](auto& m) -> double& { return m.knee.height; }, 0.8,
       "knee height is 0.8 m and the thigh height is 0.76 m"},
      {[](auto& m) -> double& { return m.thigh.height; }, 0.768, "thigh height is 0.768 m and"},
      {[](auto& m) -> double& { return m.crotch_height; }, 0.86, "crotch height is 0.86 m and"},
      {[](auto& m) -> double& { return m.hip.height; }, 1.04, "hip height is 1.04 m and"},
      {[](auto& m) -> double& { return m.ankle.height; }, 0.45, "ankle height is 0.45 m and"},
      {[](auto& m) -> double& { return m.thigh.girth; }, 0.7, "of 0.98 m; give a thigh girth of at most"}};
  for (const Spoiled& one : all) {
    BodyMeasures measures;
    one.of(measures) = one.value;
    EXPECT_THAT(sentence_of<InputError>([&] { mannequin(measures); }), HasSubstr(one.says));
  }
}

TEST(Mannequin, TheStanceAskedForIsEnough) {
  BodyMeasures measures;
  measures.stance = 0.08;
  const std::string complaint = sentence_of<InputError>([&] { mannequin(measures); });
  EXPECT_THAT(complaint,
              AllOf(HasSubstr("stance is 0.08 m"), HasSubstr("its legs would touch at the height")));
  const std::string before = "give a stance of at least ";
  ASSERT_THAT(complaint, HasSubstr(before));
  const double needed = std::stod(complaint.substr(complaint.find(before) + before.size()));
  measures.stance = needed;
  EXPECT_NO_THROW(mannequin(measures));
  measures.stance = needed - 0.0015;
  EXPECT_THROW(mannequin(measures), InputError);
}

TEST(Mannequin, PointsAroundAreChecked) {
  for (const std::uint32_t cells_around : {0U, 12U, 50U, 516U})
    EXPECT_THAT(sentence_of<InputError>([&] { mannequin({}, cells_around); }),
                AllOf(HasSubstr(" " + std::to_string(cells_around) + " points"),
                      HasSubstr("give a multiple of four")));
}

}  // namespace
}  // namespace mssim
