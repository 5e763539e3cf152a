#include "bench/roofline/machine_peak.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mssim {
namespace {

constexpr std::size_t in_first_level = 16 << 10, beyond_caches = 128 << 20;

TEST(MachinePeak, IsPositiveAndNoMoreThanHardwareCanDo) {
  // Wide bounds that hold for every processor there is: a slow core still moves 100 MB/s, and no core does
  // 64 lanes of two operations at 8 GHz per unit, four units.
  const MachinePeak peak = measure_peak(1, in_first_level);
  EXPECT_GT(peak.bytes_per_second, 1e8);
  EXPECT_LT(peak.bytes_per_second, 1e13);
  EXPECT_GT(peak.flops_per_second, 1e8);
  EXPECT_LT(peak.flops_per_second, 4 * 2 * 64 * 8e9);
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
