#include "charts/axis_scale.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "charts/plotted_values.h"

namespace mssim {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels_of(const AxisScale& scale) {
  std::vector<std::string> labels;
  for (const Tick& tick : scale.ticks) labels.push_back(tick.label);
  return labels;
}

TEST(AxisScale, LogarithmicTicksArePowersOfTen) {
  EXPECT_THAT(labels_of(logarithmic_scale(0.005, 3000)),
              ElementsAre("0.01", "0.1", "1", "10", "100", "1,000"));
}

TEST(AxisScale, LogarithmicTicksAreCloserWhereThereAreFewPowers) {
  EXPECT_THAT(labels_of(logarithmic_scale(2500, 350000)),
              ElementsAre("3,000", "10,000", "30,000", "100,000", "300,000"));
  EXPECT_THAT(labels_of(logarithmic_scale(1.5, 9)), ElementsAre("2", "5", "10"));
  EXPECT_GE(logarithmic_scale(4.1, 4.2).ticks.size(), 2U);
}

TEST(AxisScale, LargeAndSmallPowersAreWrittenAsSuch) {
  EXPECT_THAT(labels_of(logarithmic_scale(2e-9, 3e-6)), ElementsAre("10⁻⁸", "10⁻⁷", "10⁻⁶"));
  EXPECT_THAT(labels_of(logarithmic_scale(2e10, 9e10)), ElementsAre("2·10¹⁰", "5·10¹⁰", "10¹¹"));
}

TEST(AxisScale, ZeroIsShownWhereItIsNear) {
  EXPECT_EQ(linear_scale(1, 10).low, 0);
  EXPECT_EQ(linear_scale(4.9, 10).low, 0);
  EXPECT_GT(linear_scale(5.1, 10).low, 4);
  EXPECT_LT(linear_scale(9, 10).low, 9);
  EXPECT_GT(linear_scale(9, 10).low, 0);
  EXPECT_EQ(linear_scale(-10, -1).high, 0);
}

TEST(AxisScale, BarsBeginAtZero) {
  EXPECT_EQ(scale_from_zero(9, 10).low, 0);
  EXPECT_EQ(scale_from_zero(-10, -9).high, 0);
  EXPECT_LT(scale_from_zero(-1, 5).low, -1);
}

TEST(AxisScale, EachPairOfValuesHasRoomAndTicks) {
  using Scale = AxisScale (*)(double, double);
  const std::vector<double> values{1 / largest_plotted, 1e-9, 0.1, 1, 1 + 1e-12, 3, 1e5, largest_plotted};
  for (const Scale scale : {Scale{linear_scale}, Scale{scale_from_zero}, Scale{logarithmic_scale}})
    for (const double low : values)
      for (const double high : values) {
        if (low > high) continue;
        const AxisScale made = scale(low, high);
        EXPECT_TRUE(std::isfinite(made.low) && std::isfinite(made.high)) << low << ' ' << high;
        EXPECT_LT(made.low, made.high) << low << ' ' << high;
        EXPECT_LE(made.low, low);
        EXPECT_GE(made.high, high);
        EXPECT_FALSE(made.ticks.empty()) << low << ' ' << high;
        EXPECT_LE(made.ticks.size(), 9U) << low << ' ' << high;
        for (const Tick& tick : made.ticks) {
          EXPECT_LE(made.low, tick.value * (1 + 1e-8));
          EXPECT_GE(made.high * (1 + 1e-8), tick.value);
        }
      }
  for (const auto& [low, high] : {std::pair{0.0, 0.0}, {-1.0, 1.0}, {-largest_plotted, largest_plotted}})
    for (const Scale scale : {Scale{linear_scale}, Scale{scale_from_zero}}) {
      EXPECT_LT(scale(low, high).low, scale(low, high).high);
      EXPECT_GE(scale(low, high).ticks.size(), 2U);
    }
}

}  // namespace
}  // namespace mssim
