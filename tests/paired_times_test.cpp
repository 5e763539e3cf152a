#include "bench/paired_times.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace mssim {
namespace {

constexpr double threshold = 0.05;

/// Rounds whose own speed varies by a factor of three, in which NEW takes `factor` times as long, give or
/// take `noise`.
PairedTimes pairs_of(std::size_t rounds, double factor, double noise, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> speed(1, 3), luck(-noise, noise);
  PairedTimes times{"cloth2500", "openmp", "semi-euler", {}, {}, {}};
  for (std::size_t round = 0; round < rounds; ++round) {
    times.base_ms.push_back(speed(random));
    times.new_ms.push_back(times.base_ms.back() * factor * (1 + luck(random)));
  }
  return times;
}

TEST(PairedTimes, GiveTheVerdictThoughRoundsDifferFarMore) {
  EXPECT_EQ(compare_pairs(pairs_of(20, 1.1, 0.02), threshold).verdict, Verdict::slower);
  EXPECT_EQ(compare_pairs(pairs_of(20, 0.9, 0.02), threshold).verdict, Verdict::faster);
  const ComparedRow same = compare_pairs(pairs_of(20, 1, 0.02), threshold);
  EXPECT_EQ(same.verdict, Verdict::same);
  EXPECT_NEAR(same.ratio->ratio, 1, 0.02);
  EXPECT_GE(same.base_ms, 1);
  EXPECT_LE(same.base_ms, 3);
}

TEST(PairedTimes, OfFewerThanEightRoundsAreUndecided) {
  const ComparedRow seven = compare_pairs(pairs_of(7, 2, 0), threshold);
  EXPECT_EQ(seven.verdict, Verdict::undecided);
  EXPECT_EQ(seven.samples_needed, 8U);
  EXPECT_EQ(compare_pairs(pairs_of(7, 1, 0.001), threshold).verdict, Verdict::undecided);
  EXPECT_EQ(compare_pairs(pairs_of(8, 2, 0.001), threshold).verdict, Verdict::slower);
  EXPECT_EQ(compare_pairs(pairs_of(1, 1, 0), threshold).verdict, Verdict::undecided);
}

TEST(PairedTimes, AreSettledWhenTheIntervalIsNarrowerThanTheThreshold) {
  EXPECT_FALSE(is_settled(pairs_of(7, 1, 0), threshold));
  EXPECT_TRUE(is_settled(pairs_of(8, 1, 0.01), threshold));
  EXPECT_TRUE(is_settled(pairs_of(8, 1.5, 0.01), threshold));
  EXPECT_FALSE(is_settled(pairs_of(8, 1.5, 0.3), threshold));
  EXPECT_FALSE(is_settled(pairs_of(8, 1, 0.01), 0.001));
}

TEST(PairedTimes, ThatAreLostSayWhyAndAreSettled) {
  PairedTimes times = pairs_of(2, 1, 0);
  times.lost = "failed: not verified";
  EXPECT_TRUE(is_settled(times, threshold));
  const ComparedRow row = compare_pairs(times, threshold);
  EXPECT_EQ(row.verdict, Verdict::lost);
  EXPECT_EQ(row.reason, "failed: not verified");
}

TEST(PairedTimes, MeasuredUntilSettledRarelyAlarmAndFindTenPercent) {
  // 200 studies each, with noise of a tenth a round: rounds are added until the interval is narrow enough.
  const auto study = [](double factor, Verdict verdict) {
    int count = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
      const PairedTimes all = pairs_of(400, factor, 0.1, seed);
      PairedTimes so_far{"", "", "", {}, {}, {}};
      for (std::size_t round = 0; round < 400 && !is_settled(so_far, threshold); ++round) {
        so_far.base_ms.push_back(all.base_ms[round]);
        so_far.new_ms.push_back(all.new_ms[round]);
      }
      count += compare_pairs(so_far, threshold).verdict == verdict;
    }
    return count;
  };
  EXPECT_LE(study(1, Verdict::slower), 4);
  EXPECT_LE(study(1, Verdict::faster), 4);
  EXPECT_GE(study(1.1, Verdict::slower), 194);
}

}  // namespace
}  // namespace mssim
