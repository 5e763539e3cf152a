#include "bench/roofline/machine_peak.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

namespace mssim {
namespace {

constexpr std::size_t in_first_level = 16 << 10, beyond_caches = 128 << 20;

/// The best rate of many calls of `work`, each of which does `amount`.
template <class Work>
double best_rate(double amount, const Work& work) {
  double seconds = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds =
        std::min(seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return amount / seconds;
}

constexpr double slack_for_a_busy_machine = 0.8;

TEST(MachinePeak, IsNotBelowWhatPlainLoopsReach) {
  constexpr std::size_t size = in_first_level / 12, passes = 100;
  std::vector<float> a(size), b(size, 1), c(size, 2);
  const double triad = best_rate(12.0 * size * passes, [&] {
    for (std::size_t pass = 0; pass < passes; ++pass) {
      for (std::size_t i = 0; i < size; ++i) a[i] = b[i] + 0.5F * c[i];
      asm volatile("" : : "r"(a.data()) : "memory");  // every pass counts
    }
  });
  std::array<float, 8> chains{0, 1, 2, 3, 4, 5, 6, 7};
  constexpr std::size_t rounds = 20'000;
  const double multiply_adds = best_rate(2.0 * chains.size() * rounds, [&] {
    for (std::size_t round = 0; round < rounds; ++round)
      for (float& chain : chains) chain = chain * 0.5F + 1;
    asm volatile("" : : "r"(chains.data()) : "memory");
  });
  const MachinePeak peak = measure_peak(1, in_first_level);
  EXPECT_GT(peak.bytes_per_second, slack_for_a_busy_machine * triad);
  EXPECT_GT(peak.flops_per_second, slack_for_a_busy_machine * multiply_adds);
}

TEST(MachinePeak, OfOperationsAndOfTheFirstCacheGoTogether) {
  const MachinePeak peak = measure_peak(1, in_first_level);
  // The triad does 2 operations for 12 bytes, and no processor does many more than its first cache can feed.
  EXPECT_GT(peak.flops_per_second, slack_for_a_busy_machine * peak.bytes_per_second * 2 / 12);
  EXPECT_LT(peak.flops_per_second, 8 * peak.bytes_per_second);
}

TEST(MachinePeak, OfMainMemoryIsNotAboveThatOfTheFirstCache) {
  // Fastest of many, and several times apart where caches exist: the factor is slack for a busy machine.
  EXPECT_LT(measure_peak(1, beyond_caches).bytes_per_second,
            1.5 * measure_peak(1, in_first_level).bytes_per_second);
}

TEST(MachinePeak, WorksForAnyWorkingSetAndMoreThreadsThanCores) {
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{5000}}) {
    const MachinePeak peak = measure_peak(3, bytes);
    EXPECT_TRUE(std::isfinite(peak.bytes_per_second) && peak.bytes_per_second > 0) << bytes;
    EXPECT_TRUE(std::isfinite(peak.flops_per_second) && peak.flops_per_second > 0) << bytes;
  }
}

TEST(RooflineFraction, ComparesWithTheRoofThatBounds) {
  const MachinePeak peak{100, 1000};
  EXPECT_DOUBLE_EQ(roofline_fraction({50, 100}, 1, peak), 0.5);  // bytes bound: 0.5 s against 0.1 s
  EXPECT_DOUBLE_EQ(roofline_fraction({10, 900}, 1, peak), 0.9);  // operations bound
  EXPECT_DOUBLE_EQ(roofline_fraction({10, 900}, 3, peak), 0.3);
}

}  // namespace
}  // namespace mssim
