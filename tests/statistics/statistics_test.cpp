#include "statistics/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

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

TEST(MedianIntervalCoverage, EqualsPublishedExamples) {
  // Wikipedia, "Order statistic", the small-sample example of six observations.
  EXPECT_NEAR(rank_coverage(6, 1), 31.0 / 32, 1e-12);
  EXPECT_NEAR(rank_coverage(6, 2), 25.0 / 32, 1e-12);
  EXPECT_NEAR(rank_coverage(6, 3), 5.0 / 16, 1e-12);
  // C. Zaiontz, Real Statistics Using Excel, "Confidence Intervals for Order Statistics, Medians and
  // Percentiles", example 1: 35 observations, from the 17th to the 19th.
  EXPECT_NEAR(rank_coverage(35, 17), 0.264121, 5e-7);
}

TEST(MedianIntervalCoverage, AsksForTheRanksOfThePrintedTables) {
  // Largest rank with at least 95 %, as in the tables of textbooks on nonparametric statistics:
  // n = 8: 99.2 % and next 93.0; 9: 96.1, 82.0; 11: 98.8, 93.5; 14: 98.7, 94.3; 17: 95.1, 85.7;
  // 20: 95.9, 88.5.
  constexpr std::array<std::array<std::size_t, 2>, 10> table{
      {{6, 1}, {7, 1}, {8, 1}, {9, 2}, {10, 2}, {11, 2}, {12, 3}, {14, 3}, {17, 5}, {20, 6}}};
  for (const auto& [n, rank] : table) EXPECT_EQ(interval_rank(n), rank) << n << " samples";
  EXPECT_EQ(interval_rank(5), 0U);
}

TEST(MedianIntervalCoverage, IsTheNarrowestAboveNinetyFivePercentAtEverySize) {
  for (const std::size_t n : {6UL, 7UL, 21UL, 50UL, 333UL, 1074UL, 1075UL, 5000UL}) {
    const std::size_t rank = interval_rank(n);
    EXPECT_GE(rank_coverage(n, rank), interval_confidence) << n;
    EXPECT_LT(rank_coverage(n, rank + 1), interval_confidence) << n;
  }
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

TEST(MedianInterval, HoldsTheTrueMedianAsOftenAsItSays) {
  // 20,000 samples of 9 from a skewed distribution whose median is ln 2. The expected share is 0.9609 with a
  // standard error of 0.0014; the seed is fixed.
  std::mt19937_64 random(1);
  std::exponential_distribution<double> draw(1);
  std::array<double, 9> samples{};
  int holds = 0;
  constexpr int trials = 20000;
  for (int trial = 0; trial < trials; ++trial) {
    std::generate(samples.begin(), samples.end(), [&] { return draw(random); });
    const MedianInterval interval = median_interval(samples);
    holds += interval.low <= std::log(2.0) && std::log(2.0) <= interval.high;
  }
  EXPECT_NEAR(static_cast<double>(holds) / trials, rank_coverage(9, 2), 5 * 0.0014);
}

TEST(MedianRatio, CancelsWhatSlowsAWholeRoundDown) {
  // Every round is a different multiple slower, the second program always three times the first.
  const std::vector<double> base{1, 5, 2, 9, 3, 4, 7};
  std::vector<double> other(base.size());
  std::transform(base.begin(), base.end(), other.begin(), [](double time) { return 3 * time; });
  const MedianInterval ratio = median_ratio(other, base);
  EXPECT_DOUBLE_EQ(ratio.median, 3);
  EXPECT_DOUBLE_EQ(ratio.low, 3);
  EXPECT_DOUBLE_EQ(ratio.high, 3);
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

}  // namespace
}  // namespace mssim
