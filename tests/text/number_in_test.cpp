#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "text/text.h"

namespace mssim {
namespace {

TEST(NumberIn, ReadsTheWholeTextWithOrWithoutASign) {
  EXPECT_EQ(number_in<int>("12"), 12);
  EXPECT_EQ(number_in<int>("+12"), 12);
  EXPECT_EQ(number_in<int>("-12"), -12);
  EXPECT_EQ(number_in<double>("1e-3"), 1e-3);
  EXPECT_EQ(number_in<double>("+0.5"), 0.5);
}

TEST(NumberIn, RefusesWhatIsNoNumberOrNotOnlyOne) {
  for (const char* text : {"", "+", "-", "+-1", "--1", "1 ", " 1", "1x", "x", "0x10", "1,5"}) {
    EXPECT_EQ(number_in<int>(text), std::nullopt) << text;
    EXPECT_EQ(number_in<double>(text), std::nullopt) << text;
  }
}

TEST(NumberIn, RefusesWhatDoesNotFit) {
  EXPECT_EQ(number_in<std::int64_t>("9223372036854775807"), INT64_MAX);
  EXPECT_EQ(number_in<std::int64_t>("9223372036854775808"), std::nullopt);
  EXPECT_EQ(number_in<int>("2147483648"), std::nullopt);
  EXPECT_EQ(number_in<int>("1.0"), std::nullopt);
  EXPECT_EQ(number_in<double>("1e400"), std::nullopt);
}

}  // namespace
}  // namespace mssim
