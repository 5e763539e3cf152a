#include "commands/arguments/arguments.h"

#include <gtest/gtest.h>

#include <string>

namespace mssim {
namespace {

std::string refusal(const ValueRule& rule, std::string text) { return rule(text); }

TEST(ValueRule, PositiveNumberIsFiniteAndAboveZero) {
  const ValueRule rule = positive_number();
  EXPECT_EQ(refusal(rule, "1e-9"), "");
  for (const std::string text : {"0", "-1", "inf", "nan", "1s", ""})
    EXPECT_EQ(refusal(rule, text), '"' + text + "\" is not a positive number");
}

TEST(ValueRule, RangesIncludeTheirEnds) {
  const ValueRule number = number_between(1, 86400);
  EXPECT_EQ(refusal(number, "1"), "");
  EXPECT_EQ(refusal(number, "86400"), "");
  EXPECT_EQ(refusal(number, "0.999"), "\"0.999\" is not a number from 1 to 86400");
  EXPECT_EQ(refusal(number, "86400.1"), "\"86400.1\" is not a number from 1 to 86400");
  const ValueRule whole = whole_number(1, 4096);
  EXPECT_EQ(refusal(whole, "1"), "");
  EXPECT_EQ(refusal(whole, "4096"), "");
  for (const std::string text : {"0", "4097", "1.5", "0x10", "99999999999999999999"})
    EXPECT_EQ(refusal(whole, text), '"' + text + "\" is not a whole number from 1 to 4096");
}

TEST(ValueRule, AWordBecomesItsOwnSpelling) {
  const ValueRule rule = one_of("format", {"table", "csv"});
  std::string text = "TaBLe";
  EXPECT_EQ(rule(text), "");
  EXPECT_EQ(text, "table");
  EXPECT_EQ(refusal(rule, "tabel"),
            "unknown format \"tabel\" (did you mean table?): known are table and csv");
}

TEST(ValueRule, WhatItQuotesIsPrintable) {
  EXPECT_EQ(refusal(positive_number(), "\x1b[2J"), "\"\\u001b[2J\" is not a positive number");
}

}  // namespace
}  // namespace mssim
