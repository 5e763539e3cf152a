#include "bench/job/job.h"

#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(SampleLength, FillsTheTimeThatASampleIsToTake) {
  EXPECT_EQ(sample_steps(1e-3, 0.1, 1e-9), 100);
  EXPECT_EQ(sample_steps(10, 0.1, 1e-9), 1);
}

TEST(SampleLength, IsLimitedUnlessTheClockIsTooCoarseForThat) {
  EXPECT_EQ(sample_steps(1e-6, 0.1, 1e-9), max_sample_steps);
  // 2000 steps would be 20 microseconds; a thousand steps of the clock are a millisecond.
  EXPECT_EQ(sample_steps(1e-8, 0.1, 1e-6), 100'000);
  // Never longer than asked for.
  EXPECT_EQ(sample_steps(1e-8, 1e-4, 1e-6), 10'000);
  EXPECT_GE(sample_steps(0, 0.1, 1e-9), 1);
}

TEST(WarmUp, EndsWhenTwoTrialsInARowWereNotFaster) {
  EXPECT_FALSE(is_warm({}));
  EXPECT_FALSE(is_warm(std::vector{1.0, 1.0}));
  EXPECT_TRUE(is_warm(std::vector{1.0, 1.0, 1.0}));
  EXPECT_TRUE(is_warm(std::vector{1.0, 0.99, 1.5}));
  EXPECT_FALSE(is_warm(std::vector{5.0, 3.0, 2.0}));
  // Two in a hundred are no change.
  EXPECT_TRUE(is_warm(std::vector{1.0, 0.981, 0.981}));
  EXPECT_FALSE(is_warm(std::vector{1.0, 0.979, 0.979}));
  EXPECT_FALSE(is_warm(std::vector{5.0, 3.0, 2.0, 1.5, 1.2}));
  EXPECT_FALSE(is_warm(std::vector{5.0, 3.0, 1.0, 1.0}));
  EXPECT_TRUE(is_warm(std::vector{5.0, 3.0, 1.0, 1.0, 1.0}));
  EXPECT_TRUE(is_warm(std::vector{5.0, 3.0, 1.0, 7.0, 0.99}));
}

}  // namespace
}  // namespace mssim
