// Jeans that are dressed fit, and for each bound of a fit there is a case that only this bound, or it first,
// finds out.
#include "tests/support/dressed_jeans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/support/garment_system.h"

namespace mssim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr SettlingRule two_seconds{.longest_s = 2};

Dressed dressed_after(const std::function<void(DressingCase&)>& change,
                      const SettlingRule& rule = two_seconds) {
  DressingCase jeans("jeans1k");
  change(jeans);
  return dressed(jeans, rule);
}

/// The body's surface as maps that lie this far before it.
void let_maps_lie(DressingCase& jeans, double offset) {
  const double pixel = std::get<GarmentSpec>(jeans.spec.content).pixel_m;
  put_on(jeans.system, jeans.body->surface, {.pixel = pixel, .offset = offset});
}

TEST(DressedJeans, FitWithinAllBounds) {
  const Dressed jeans = dressed_after([](DressingCase&) {});
  EXPECT_THAT(jeans.found, IsEmpty());
  EXPECT_EQ(jeans.fit.rows_astray, 0U);
  EXPECT_GE(jeans.fit.rows, 40U);
  EXPECT_GT(jeans.fit.side_distance.value(), 0.003) << "the skin alone";
}

TEST(DressedJeans, WithoutForceAreNotSewn) {
  const Dressed jeans = dressed_after(
      [](DressingCase& on) {
        on.garment().dressing.seam_force = 0;
        on.garment().dressing.longest_seaming_s = 100;
      },
      {.longest_s = 0.3});
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the seams did not close")));
}

TEST(DressedJeans, WhoseSewnSeamsDoNotCloseGape) {
  const Dressed jeans = dressed_after([](DressingCase& on) { on.garment().dressing.closing_share = 0; });
  EXPECT_TRUE(jeans.result.seamed_at);
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the largest gap of a seam is ")));
}

TEST(DressedJeans, LookedAtTooEarlyAreNotAtRest) {
  const Dressed jeans = dressed_after([](DressingCase&) {}, {.longest_s = 0.3});
  EXPECT_TRUE(jeans.result.seamed_at);
  EXPECT_THAT(jeans.found, Contains(StartsWith("the garment did not come to rest; try ")));
}

TEST(DressedJeans, SinkIntoABodyWhoseMapsLieInside) {
  const Dressed jeans = dressed_after([](DressingCase& on) { let_maps_lie(on, -0.004); });
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the deepest node inside the body is ")));
}

TEST(DressedJeans, LetTheBodyThroughFacesBetweenCleanNodes) {
  // Cells of 27 mm and no room for their sagitta, 2.3 mm where the body bends with a radius of 40 mm.
  const Dressed jeans = dressed_after([](DressingCase& on) { let_maps_lie(on, 0.0003); });
  EXPECT_LT(jeans.fit.deepest_node, 1e-3);
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the deepest point of a face inside the body is ")));
}

TEST(DressedJeans, OfLimpClothAreOverlongWithoutCorrection) {
  const Dressed jeans = dressed_after([](DressingCase& on) {
    for (auto& material : on.system.materials) material.stiffness *= 0.1;
    on.garment().dressing.correction = VelocityCorrection::none;
  });
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the 99th percentile of elongations is ")));
  EXPECT_THAT(jeans.found, Contains(HasSubstr("the 99.9th percentile of elongations is ")));
}

TEST(DressedJeans, ThatFallWhileTheyAreSewnPassTheNaiveChecksAndAreFoundTooLow) {
  const Dressed jeans = dressed_after([](DressingCase& on) {
    on.garment().dressing.seaming_gravity = 1;
    on.garment().dressing.seam_force = 1;
  });
  EXPECT_TRUE(jeans.result.seamed_at);
  EXPECT_LT(jeans.fit.largest_gap, 1e-3);
  EXPECT_LT(jeans.fit.deepest_node, 1e-3);
  EXPECT_THAT(jeans.found,
              Contains(HasSubstr("the distance of the upper edge from its place in the pattern is -")));
}

TEST(DressedJeans, ThatAreDrawnUpHaveTheirCrotchTooHigh) {
  SceneSpec spec = find_scene("jeans1k");
  std::get<GarmentSpec>(spec.content).jeans.value().measures.crotch_ease = 0.04;
  spec.gravity_m_per_s2 = -50;
  const Dressed jeans = dressed(DressingCase(spec), two_seconds);
  EXPECT_THAT(jeans.found,
              Contains(HasSubstr("the distance of the crotch from its place in the pattern is ")));
  EXPECT_GT(jeans.fit.meeting_rise.value(), 0.03);
}

TEST(DressedJeans, ThatAreWideAtTheHipStandOffAtTheSides) {
  SceneSpec spec = find_scene("jeans1k");
  std::get<GarmentSpec>(spec.content).jeans.value().measures.hip_ease = 0.08;
  const Dressed jeans = dressed(DressingCase(spec), two_seconds);
  EXPECT_THAT(jeans.found, ElementsAre(HasSubstr("stands off at the sides: ")));
  EXPECT_GT(jeans.fit.side_distance.value(), 0.015);
  EXPECT_GT(jeans.fit.side_distance_height.value(), 0.758);
  EXPECT_LT(jeans.fit.side_distance_height.value(), 0.86);
}

TEST(DressedJeans, SewnBeforeTheBodyDoNotGoAroundIt) {
  const Dressed jeans = dressed_after([](DressingCase& on) {
    for (Vec3d& node : on.system.start.position) node.z += 0.3;
    round_to_single(on.system.start);
  });
  EXPECT_TRUE(jeans.result.seamed_at);
  EXPECT_THAT(jeans.found, Contains(HasSubstr("rows that do not go once around their limb")));
}

}  // namespace
}  // namespace mssim
