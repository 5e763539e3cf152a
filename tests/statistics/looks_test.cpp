#include <gtest/gtest.h>

#include <vector>

#include "statistics/statistics.h"

namespace mssim {
namespace {

TEST(Looks, AreTakenAfterHalfAsManyMoreEachTime) {
  std::vector<std::size_t> due;
  for (std::size_t pairs = 1; pairs <= 163; ++pairs)
    if (look_at(pairs).pairs == pairs) due.push_back(pairs);
  EXPECT_EQ(due, (std::vector<std::size_t>{10, 15, 22, 33, 49, 73, 109, 163}));
}

TEST(Looks, BetweenTwoAreTheNextOne) {
  for (const std::size_t pairs : {11UL, 12UL, 14UL, 15UL}) {
    EXPECT_EQ(look_at(pairs).pairs, 15U);
    EXPECT_DOUBLE_EQ(look_at(pairs).fraction, 1. / 6);
  }
  EXPECT_EQ(look_at(1).pairs, first_look_pairs);
}

TEST(Looks, SpendTheWholeErrorHoweverManyThereAre) {
  double spent = 0;
  int number = 0;
  for (std::size_t pairs = 1; pairs < 1'000'000; pairs = look_at(pairs).pairs + 1) {
    spent += look_at(pairs).fraction;
    ++number;
    EXPECT_NEAR(spent, 1 - 1. / (number + 1), 1e-12);
  }
  EXPECT_GT(number, 25);
  EXPECT_LT(spent, 1);
}

}  // namespace
}  // namespace mssim
