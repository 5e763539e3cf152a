#include "bench/results/comparison.h"
#include "statistics/rank_tests.h"
#include "statistics/statistics.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Rounds whose own speed varies by a factor of three, in which NEW takes `factor` times as long, give or
/// take `noise`.
PairedTimes pairs_of(std::size_t rounds, double factor, double noise, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> speed(1, 3), luck(-noise, noise);
  PairedTimes times{{"cloth2500", "openmp", "semi-euler"}, {}, {}, {}};
  for (std::size_t round = 0; round < rounds; ++round) {
    times.base_ms.push_back(speed(random));
    times.new_ms.push_back(times.base_ms.back() * factor * (1 + luck(random)));
  }
  return times;
}

PairedTimes first(const PairedTimes& all, std::size_t rounds) {
  PairedTimes times = all;
  times.base_ms.resize(rounds);
  times.new_ms.resize(rounds);
  return times;
}

/// What is known when the pairs are settled, or after all of them.
PairedTimes until_settled(const PairedTimes& all) {
  for (std::size_t rounds = 1; rounds < all.base_ms.size(); ++rounds)
    if (is_settled(first(all, rounds), threshold)) return first(all, rounds);
  return all;
}

TEST(PairedTimes, GiveTheVerdictThoughRoundsDifferFarMore) {
  EXPECT_EQ(compare_pairs(pairs_of(22, 1.1, 0.02), threshold).verdict, Verdict::slower);
  EXPECT_EQ(compare_pairs(pairs_of(22, 0.9, 0.02), threshold).verdict, Verdict::faster);
  const ComparedRow same = compare_pairs(pairs_of(22, 1, 0.02), threshold);
  EXPECT_EQ(same.verdict, Verdict::same);
  EXPECT_NEAR(same.ratio->ratio, 1, 0.02);
  EXPECT_GE(same.base_ms, 1);
  EXPECT_LE(same.base_ms, 3);
}

TEST(PairedTimes, AreUndecidedBeforeTheFirstLook) {
  const ComparedRow nine = compare_pairs(pairs_of(9, 2, 0), threshold);
  EXPECT_EQ(nine.verdict, Verdict::undecided);
  EXPECT_EQ(nine.samples_needed, 10U);
  EXPECT_EQ(compare_pairs(pairs_of(9, 1, 0.001), threshold).verdict, Verdict::undecided);
  EXPECT_EQ(compare_pairs(pairs_of(10, 2, 0.001), threshold).verdict, Verdict::slower);
  EXPECT_EQ(compare_pairs(pairs_of(1, 1, 0), threshold).verdict, Verdict::undecided);
}

TEST(PairedTimes, AskForAsManySamplesAsALookHas) {
  const ComparedRow row = compare_pairs(pairs_of(12, 1.06, 0.1), threshold);
  ASSERT_EQ(row.verdict, Verdict::undecided);
  ASSERT_TRUE(row.samples_needed);
  EXPECT_GT(*row.samples_needed, 12U);
  EXPECT_EQ(look_at(*row.samples_needed).pairs, *row.samples_needed);
}

TEST(PairedTimes, AreSettledWhenTheWholeIntervalIsWithinOrBeyondTheThreshold) {
  EXPECT_FALSE(is_settled(pairs_of(9, 1, 0), threshold));
  EXPECT_TRUE(is_settled(pairs_of(10, 1, 0.01), threshold));
  EXPECT_TRUE(is_settled(pairs_of(10, 1.5, 0.1), threshold));
  EXPECT_TRUE(is_settled(pairs_of(10, 0.7, 0.1), threshold));
  EXPECT_FALSE(is_settled(pairs_of(10, 1.5, 0.9), threshold));
  EXPECT_FALSE(is_settled(pairs_of(10, 1, 0.01), 0.001));
  // Certainly slower, and by more than the threshold if by anything, but that is not certain yet.
  const PairedTimes near = pairs_of(22, 1.06, 0.03);
  EXPECT_EQ(compare_pairs(near, threshold).verdict, Verdict::slower);
  EXPECT_FALSE(is_settled(near, threshold));
}

TEST(PairedTimes, AreNotSettledBetweenLooks) {
  EXPECT_TRUE(is_settled(pairs_of(15, 1.5, 0.01), threshold));
  EXPECT_FALSE(is_settled(pairs_of(14, 1.5, 0.01), threshold));
}

TEST(PairedTimes, ThatAreLostSayWhyAndAreSettled) {
  PairedTimes times = pairs_of(2, 1, 0);
  times.lost = "failed: not verified";
  EXPECT_TRUE(is_settled(times, threshold));
  const ComparedRow row = compare_pairs(times, threshold);
  EXPECT_EQ(row.verdict, Verdict::lost);
  EXPECT_EQ(row.reason, "failed: not verified");
}

// The shares of all looks add up to 1 (Looks), so that no look errs more often than allowed, however many
// there are.
TEST(SequentialPairs, HaveThePAndTheIntervalOfTheirTestOverTheShareOfTheLook) {
  for (const std::size_t rounds : {10UL, 12UL, 22UL, 109UL}) {
    const PairedTimes times = pairs_of(rounds, 1.02, 0.05);
    std::vector<double> differences;
    for (std::size_t i = 0; i < rounds; ++i)
      differences.push_back(std::log(times.new_ms[i] / times.base_ms[i]));
    const double share = look_at(rounds).fraction;
    const RatioEstimate ratio = *compare_pairs(times, threshold).ratio;
    EXPECT_DOUBLE_EQ(ratio.p, std::min(1., signed_rank_test(differences).p_two_sided() / share));
    const ShiftEstimate interval = signed_rank_shift(differences, share * usual_error);
    EXPECT_NEAR(ratio.low, std::exp(interval.low), 1e-12) << rounds;
    EXPECT_NEAR(ratio.high, std::exp(interval.high), 1e-12) << rounds;
  }
}

/// Rounds that a comparison takes on average, and the share that ends with a verdict.
struct Study {
  double rounds = 0, fraction = 0;
};

Study study_of(double factor, double noise, Verdict verdict) {
  constexpr int studies = 300;
  Study study;
  for (unsigned seed = 1; seed <= studies; ++seed) {
    const PairedTimes known = until_settled(pairs_of(400, factor, noise, seed));
    study.rounds += static_cast<double>(known.base_ms.size()) / studies;
    study.fraction += compare_pairs(known, threshold).verdict == verdict ? 1. / studies : 0;
  }
  return study;
}

TEST(SequentialPairs, FindTenPercentInNoiseOfAsMuch) {
  const Study slower = study_of(1.1, 0.1, Verdict::slower);
  EXPECT_GE(slower.fraction, 0.98);
  EXPECT_LE(slower.rounds, 45);
  EXPECT_LE(study_of(1, 0.1, Verdict::slower).fraction, 0.005);
  EXPECT_LE(study_of(1, 0.1, Verdict::faster).fraction, 0.005);
}

TEST(SequentialPairs, RarelyStopOnTheWrongSideOfTheThreshold) {
  // Slower indeed, but by less than what matters: that it is slower may be found, though not that it is by
  // more than the threshold.
  const auto settled_slower = [](const PairedTimes& times) {
    return is_settled(times, threshold) && compare_pairs(times, threshold).verdict == Verdict::slower;
  };
  int wrong = 0;
  for (unsigned seed = 1; seed <= 500; ++seed)
    wrong += settled_slower(until_settled(pairs_of(200, 1.045, 0.08, seed)));
  EXPECT_LE(wrong, 500 * usual_error / 2);
}

}  // namespace
}  // namespace mssim
