#include <gtest/gtest.h>

#include "geometry/geometry.h"

namespace mssim {
namespace {

TEST(MonotoneCurve, GoesThroughItsValuesAndStaysBeyondTheEnds) {
  const MonotoneCurve curve({0, 1, 3}, {5, 7, 6});
  EXPECT_EQ(curve(0), 5);
  EXPECT_EQ(curve(1), 7);
  EXPECT_EQ(curve(3), 6);
  EXPECT_EQ(curve(-2), 5);
  EXPECT_EQ(curve(9), 6);
}

TEST(MonotoneCurve, ALineIsALine) {
  const MonotoneCurve curve({0, 1, 1.5, 4}, {1, 3, 4, 9});
  for (double x = 0; x <= 4; x += 0.125) EXPECT_NEAR(curve(x), 1 + 2 * x, 1e-14);
}

TEST(MonotoneCurve, SlopesAreWeightedHarmonicMeans) {
  // Equal widths and secants of 1 and 3: a slope of 2 / (1 + 1/3) = 1.5 in the middle, 1 and 3 at the ends.
  // The cubic halfway is the mean of the values plus an eighth of the width times the difference of the
  // slopes.
  const MonotoneCurve curve({0, 1, 2}, {0, 1, 4});
  EXPECT_NEAR(curve(0.5), 0.5 + (1 - 1.5) / 8, 1e-15);
  EXPECT_NEAR(curve(1.5), 2.5 + (1.5 - 3) / 8, 1e-15);
}

TEST(MonotoneCurve, SlopesWeighTheNarrowerSideMore) {
  // Fritsch and Butland: widths 1 and 3, secants 1 and 2 weigh 2 * 3 + 1 = 7 and 3 + 2 * 1 = 5: a slope of
  // 12 / (7 / 1 + 5 / 2) = 24 / 19.
  const MonotoneCurve curve({0, 1, 4}, {0, 1, 7});
  EXPECT_NEAR(curve(0.5), 0.5 + (1 - 24. / 19) / 8, 1e-15);
  EXPECT_NEAR(curve(2.5), 4 + 3 * (24. / 19 - 2) / 8, 1e-15);
}

TEST(MonotoneCurve, NeverOvershoots) {
  const MonotoneCurve curve({0, 0.1, 0.2, 1, 1.1}, {0, 0, 1, 1.01, 0.2});
  double before = curve(0);
  for (int i = 1; i <= 1000; ++i) {
    const double now = curve(i / 1000.0);
    EXPECT_GE(now, before);
    before = now;
  }
  for (int i = 1; i <= 100; ++i) {
    const double now = curve(1 + i / 1000.0);
    EXPECT_LE(now, before);
    before = now;
  }
}

}  // namespace
}  // namespace mssim
