#include "statistics/statistics.h"

#include "tests/support/testing.h"

namespace mssim {
namespace {

/// 2^n P(B(n, 1/2) < rank), in whole numbers by Pascal's triangle: exact up to n = 60.
std::uint64_t draws_below(std::size_t n, std::size_t rank) {
  std::vector<std::uint64_t> row{1};
  for (std::size_t i = 0; i < n; ++i) {
    row.push_back(0);
    for (std::size_t k = row.size() - 1; k > 0; --k) row[k] += row[k - 1];
  }
  return std::accumulate(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(rank), std::uint64_t{0});
}

TEST(MedianIntervalCoverage, EqualsExactBinomialProbabilities) {
  for (std::size_t n = 1; n <= 60; ++n)
    for (std::size_t rank = 0; rank <= (n + 1) / 2; ++rank) {
      const double exact =
          1 - std::ldexp(2 * static_cast<double>(draws_below(n, rank)), -static_cast<int>(n));
      EXPECT_NEAR(rank_coverage(n, rank), exact, 1e-12) << n << " samples, rank " << rank;
    }
}

TEST(MedianIntervalCoverage, IsTheNarrowestAboveNinetyFivePercentAtEverySize) {
  for (const std::size_t n : {6UL, 7UL, 21UL, 50UL, 333UL, 1074UL, 1075UL, 5000UL}) {
    const std::size_t rank = interval_rank(n);
    EXPECT_GE(rank_coverage(n, rank), interval_confidence) << n;
    EXPECT_LT(rank_coverage(n, rank + 1), interval_confidence) << n;
  }
  EXPECT_EQ(interval_rank(5), 0U);
}

TEST(MedianInterval, OfSixOrMoreSamplesIsMadeOfSamplesAroundTheMedian) {
  const std::vector<double> samples{9, 1, 8, 2, 7, 3, 6, 4, 5, 100};
  const MedianInterval interval = median_interval(samples);
  EXPECT_EQ(interval.median, 5.5);
  EXPECT_EQ(interval.low, 2);
  EXPECT_EQ(interval.high, 9);
  EXPECT_NEAR(interval.coverage, 1 - 22. / 1024, 1e-12);
}

TEST(MedianInterval, OfFewerThanSixSamplesIsTheirRangeWithWhatItIsWorth) {
  const MedianInterval one = median_interval(std::vector{3.0});
  EXPECT_EQ(one.median, 3);
  EXPECT_EQ(one.low, 3);
  EXPECT_EQ(one.high, 3);
  EXPECT_NEAR(one.coverage, 0, 1e-12);
  const MedianInterval five = median_interval(std::vector{5.0, 1.0, 4.0, 2.0, 3.0});
  EXPECT_EQ(five.median, 3);
  EXPECT_EQ(five.low, 1);
  EXPECT_EQ(five.high, 5);
  EXPECT_NEAR(five.coverage, 0.9375, 1e-12);
}

TEST(MedianRatio, IsNotTheRatioOfMedians) {
  const MedianInterval ratio = median_ratio(std::vector{1.0, 10.0, 100.0}, std::vector{10.0, 1.0, 50.0});
  EXPECT_EQ(ratio.median, 2);
  EXPECT_EQ(ratio.low, 0.1);
  EXPECT_EQ(ratio.high, 10);
}

TEST(MeanDeviation, OfTheNumbersOneToFiveIsTheTextbookOne) {
  const MeanDeviation moments = mean_deviation(std::vector{1.0, 2.0, 3.0, 4.0, 5.0});
  EXPECT_DOUBLE_EQ(moments.mean, 3);
  EXPECT_DOUBLE_EQ(moments.deviation, std::sqrt(2.5));
  EXPECT_EQ(mean_deviation(std::vector{7.0}).deviation, 0);
}

TEST(Statistics, RefuseSamplesThatHaveNoMedian) {
  EXPECT_THROW(median({}), std::invalid_argument);
  EXPECT_THROW(mean_deviation({}), std::invalid_argument);
  EXPECT_THROW(median(std::vector{1.0, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
  EXPECT_THROW(median_ratio(std::vector{1.0}, std::vector{1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(median_ratio(std::vector{1.0}, std::vector{0.0}), std::invalid_argument);
}

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

TEST(Quartiles, LieBetweenTwoSamplesAtAQuarterOfOneMoreThanThereAre) {
  const Quartiles found = quartiles(std::vector{13.0, 1.0, 7.0, 3.0});  // at places 1.25 and 3.75
  EXPECT_DOUBLE_EQ(found.first, 1.5);
  EXPECT_DOUBLE_EQ(found.third, 11.5);
}

TEST(Outliers, BeginBeyondOneAndAHalfAndThreeRangesOfTheQuartiles) {
  // Of 11 samples the quartiles are the third and the ninth: 3 and 9, which are 6 apart. The fences are 9
  // from them, at -6 and 18, and 18 from them, at -15 and 27; a sample on a fence is within it.
  const auto label = [](double sample) {
    return outliers(
        std::vector<double>{sample < 3 ? sample : 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, sample > 9 ? sample : 11});
  };
  for (const double sample : {18.0, 18.001, 20.999, 27.0}) {
    const Outlier expected = sample > 18 ? Outlier::mild : Outlier::no;
    EXPECT_EQ(label(sample).back(), expected) << sample;
    EXPECT_EQ(label(12 - sample).front(), expected) << 12 - sample;
  }
  EXPECT_EQ(label(27.001).back(), Outlier::extreme);
  EXPECT_EQ(label(-15.001).front(), Outlier::extreme);
  const auto unsorted = outliers(std::vector<double>{5, 27.001, 4, 1, 2, 3, 18.001, 6, 7, 8, 9});
  EXPECT_EQ(unsorted[1], Outlier::extreme);
  EXPECT_EQ(unsorted[6], Outlier::mild);
  EXPECT_EQ(std::ranges::count(unsorted, Outlier::no), 9);
}

TEST(Outliers, DoNotExistAmongFewOrEqualSamples) {
  for (const std::vector<double>& samples :
       {std::vector{1.0}, {1.0, 9.0}, {1.0, 2.0, 900.0}, std::vector<double>(20, 3.0)}) {
    const std::vector<Outlier> labels = outliers(samples);
    EXPECT_EQ(labels, std::vector(samples.size(), Outlier::no)) << samples.size();
  }
}

TEST(Outliers, NeedFiniteSamples) {
  EXPECT_THROW(outliers({}), std::invalid_argument);
  EXPECT_THROW(outliers(std::vector{1.0, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
}

const std::vector<double> base{1, 1.02, 0.98, 1.3, 0.97, 1.01, 1.04, 0.99};

std::vector<double> times(double factor, const std::vector<double>& values) {
  std::vector<double> result = values;
  for (double& value : result) value *= factor;
  return result;
}

TEST(RatioOfTwoSamples, IsTheFactorBetweenThem) {
  const RatioEstimate ratio = ratio_of(base, times(3, base));
  EXPECT_NEAR(ratio.ratio, 3, 1e-12);
  EXPECT_LT(ratio.low, 3);
  EXPECT_GT(ratio.high, 3);
  EXPECT_TRUE(ratio.covers);
  EXPECT_NEAR(ratio.p, 2. / 12870, 1e-9);  // all above all: one of C(16, 8) arrangements, two-sided
}

TEST(RatioOfTwoSamples, OfExchangedSamplesIsTheInverse) {
  const std::vector<double> other{1.1, 1.2, 1.15, 0.9, 1.4, 1.25, 1.18, 1.31};
  const RatioEstimate there = ratio_of(base, other), back = ratio_of(other, base);
  EXPECT_NEAR(back.ratio, 1 / there.ratio, 1e-12);
  EXPECT_NEAR(back.low, 1 / there.high, 1e-12);
  EXPECT_NEAR(back.high, 1 / there.low, 1e-12);
  EXPECT_NEAR(back.p, there.p, 1e-12);
}

TEST(RatioOfTwoSamples, IsFoundForAsManySamplesAsABenchMayTake) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> draw(0, 0.1);
  std::vector<double> x(100000), y(100000);
  std::generate(x.begin(), x.end(), [&] { return draw(random); });
  std::generate(y.begin(), y.end(), [&] { return 1.01 * draw(random); });
  const RatioEstimate ratio = ratio_of(x, y);
  EXPECT_NEAR(ratio.ratio, 1.01, 0.002);
  EXPECT_LT(ratio.low, ratio.ratio);
  EXPECT_LT(ratio.high, ratio.low * 1.003);
  EXPECT_LT(ratio.p, 1e-9);
}

TEST(PairedRatio, CancelsWhatSlowsAWholeRoundDown) {
  std::vector<double> next;
  for (std::size_t i = 0; i < base.size(); ++i)
    next.push_back(base[i] * (1.1 + 0.001 * static_cast<double>(i)));
  std::vector<double> loaded_base = base, loaded_next = next;
  loaded_base[2] *= 5;
  loaded_next[2] *= 5;
  const RatioEstimate ratio = paired_ratio(base, next), loaded = paired_ratio(loaded_base, loaded_next);
  EXPECT_NEAR(loaded.ratio, ratio.ratio, 1e-12);
  EXPECT_NEAR(loaded.low, 1.1, 1e-12 + 0.001);
  EXPECT_NEAR(loaded.p, 2. / 256, 1e-12);
}

TEST(GeometricMean, OfAHalfAndTwoIsOne) {
  EXPECT_NEAR(geometric_mean(std::vector{0.5, 2.}), 1, 1e-15);
  EXPECT_NEAR(geometric_mean(std::vector{1., 3., 9.}), 3, 1e-14);
}

TEST(Ratios, RefuseWhatIsNoTime) {
  const std::vector<double> zero{1, 0}, negative{1, -1}, nan{1, std::nan("")}, empty;
  for (const auto& bad : {zero, negative, nan, empty}) {
    EXPECT_THROW(ratio_of(base, bad), std::invalid_argument);
    EXPECT_THROW(ratio_of(bad, base), std::invalid_argument);
    EXPECT_THROW(geometric_mean(bad), std::invalid_argument);
  }
  EXPECT_THROW(paired_ratio(base, std::vector{1.}), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
