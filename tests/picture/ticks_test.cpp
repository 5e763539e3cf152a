#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "picture/legend.h"

namespace mssim {
namespace {

std::string labels(double low, double high, int most = 6) {
  std::string text;
  for (const Tick& tick : ticks_between(low, high, most)) text += (text.empty() ? "" : " ") + tick.label;
  return text;
}

TEST(Ticks, AreRoundNumbersWithTheSameDigits) {
  EXPECT_EQ(labels(0, 0.37), "0 0.1 0.2 0.3");
  EXPECT_EQ(labels(0, 1), "0 0.2 0.4 0.6 0.8 1.0");
  EXPECT_EQ(labels(-1, 1), "−1.0 −0.5 0 0.5 1.0");
  EXPECT_EQ(labels(1e-4, 3.4e-4), "0.00010 0.00015 0.00020 0.00025 0.00030");
  EXPECT_EQ(labels(12'345, 56'789), "20,000 30,000 40,000 50,000");
  EXPECT_EQ(labels(0, 3e-9), "0 1e-09 2e-09 3e-09");
  EXPECT_EQ(labels(0, 2.1e12), "0 5e+11 1e+12 1.5e+12 2e+12");
}

TEST(Ticks, HaveTheirValuesToTheLastBit) {
  for (const Tick& tick : ticks_between(0, 0.37, 6)) EXPECT_EQ(tick.value, std::stod(tick.label));
  for (const Tick& tick : ticks_between(0, 1.1e-5, 6)) EXPECT_EQ(tick.value, std::stod(tick.label));
}

TEST(Ticks, KeepEndsThatARoundingHasMoved) {
  EXPECT_EQ(labels(0, 0.1 + 0.2), labels(0, 0.3));
  EXPECT_EQ(labels(0.1 + 0.2, 0.8).substr(0, 3), "0.3");
  EXPECT_EQ(labels(-0.3, 0.3), labels(-0.1 - 0.2, 0.29999999999999993));
}

TEST(Ticks, AreAtMostAsManyAsAskedForAndLieInTheRange) {
  for (int most = 1; most <= 9; ++most)
    for (double high = 1e-7; high < 1e9; high *= 1.37)
      for (const double low : {0.0, -high, 0.3 * high, -0.1 * high}) {
        const auto ticks = ticks_between(low, high, most);
        EXPECT_LE(ticks.size(), static_cast<std::size_t>(most)) << low << ' ' << high;
        EXPECT_GE(ticks.size(), most >= 5 ? 2u : 0u) << low << ' ' << high;
        for (const Tick& tick : ticks) {
          EXPECT_GE(tick.value, low - 1e-8 * (high - low));
          EXPECT_LE(tick.value, high + 1e-8 * (high - low));
        }
      }
}

TEST(Ticks, OfARangeWithoutLengthAreItsNumber) {
  EXPECT_EQ(labels(0, 0), "0");
  EXPECT_EQ(labels(-2.5, -2.5), "−2.5");
  EXPECT_EQ(labels(1e17, 1e17 + 32), "1e+17");
  EXPECT_EQ(labels(0, 1e-300), "0");
}

TEST(Ticks, RefuseARangeThatIsNone) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ticks_between(1, 0, 6), std::invalid_argument);
  EXPECT_THROW(ticks_between(nan, 0, 6), std::invalid_argument);
  EXPECT_THROW(ticks_between(0, infinity, 6), std::invalid_argument);
  EXPECT_THROW(ticks_between(-1e308, 1e308, 6), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
