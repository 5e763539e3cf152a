#include <gtest/gtest.h>

#include <limits>

#include "text/text.h"

namespace mssim {
namespace {

TEST(FixedDecimal, HasTheDigitsAskedFor) {
  EXPECT_EQ(fixed_decimal(0.1, 3), "0.100");
  EXPECT_EQ(fixed_decimal(-2.45678, 2), "-2.46");
  EXPECT_EQ(fixed_decimal(1e9, 0), "1000000000");
  EXPECT_EQ(fixed_decimal(3e-5, 6), "0.000030");
  EXPECT_EQ(fixed_decimal(-std::numeric_limits<double>::max(), 2).size(), 313u);
}

TEST(ThreeDigits, AreSignificantOnes) {
  EXPECT_EQ(three_digits(1.23456), "1.23");
  EXPECT_EQ(three_digits(0.0123456), "0.0123");
  EXPECT_EQ(three_digits(123456), "123456");
  EXPECT_EQ(three_digits(0), "0.00");
}

TEST(TwoDigits, HaveAnExponentWhereTheNumberIsSmallOrLarge) {
  EXPECT_EQ(two_digits(2.14e-7), "2.1e-07");
  EXPECT_EQ(two_digits(0.000999), "0.001");
  EXPECT_EQ(two_digits(-60), "-60");
  EXPECT_EQ(two_digits(120), "1.2e+02");
  EXPECT_EQ(two_digits(0), "0");
}

}  // namespace
}  // namespace mssim
