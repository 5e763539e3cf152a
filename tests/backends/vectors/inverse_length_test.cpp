// The reciprocal root of each instruction set's vector code, held against double precision.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/backends/vectors/inverse_length_test.cpp"
#include "tests/backends/vectors/inverse_length.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>

#include "backends/vectors/lanes-inl.h"
#include "tests/support/testing.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

void invert(float* numbers, std::size_t count) {
  for (std::size_t i = 0; i < count; i += lane_count())
    hn::StoreU(inverse_length(hn::LoadU(RealTag(), numbers + i)).v, RealTag(), numbers + i);
}

InverseLength inverse_length_kernel() { return {hwy::TargetName(HWY_TARGET), exact_roots, &invert}; }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(inverse_length_kernel);
std::vector<InverseLength> inverse_lengths() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(inverse_length_kernel));
}

namespace {

/// Numbers whose bits follow each other from `first` on.
std::vector<float> floats_from(float first, std::size_t count) {
  std::vector<float> numbers(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers[i] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(i));
  return numbers;
}

TEST(InverseLength, IsNoWorseThanRootAndDivisionForAnyMantissa) {
  // Two exponents: the root of 4 a is twice that of a.
  constexpr std::size_t all = std::size_t{1} << 24;
  const std::vector<float> numbers = floats_from(1, all);
  for (const InverseLength& kernel : inverse_lengths()) {
    std::vector<float> results = numbers;
    kernel.invert(results.data(), all);
    double largest = 0;
    std::size_t inexact = 0;
    for (std::size_t i = 0; i < all; ++i) {
      const double exact = 1 / std::sqrt(static_cast<double>(numbers[i]));
      const double unit = exact > 0.5 ? 0x1p-24 : 0x1p-25;
      largest = std::max(largest, std::abs(results[i] - exact) / unit);
      if (results[i] != 1 / std::sqrt(numbers[i])) ++inexact;
    }
    EXPECT_LE(largest, 1.5) << kernel.instruction_set;  // units in the last place
    if (kernel.exact)
      EXPECT_EQ(inexact, 0U) << kernel.instruction_set;
    else
      EXPECT_GT(inexact, 0U) << kernel.instruction_set << " is said to have no exact roots, and has";
  }
}

TEST(InverseLength, ScalesWithPowersOfFour) {
  // Lengths from a tenth of a micrometre to a thousand kilometres.
  constexpr std::size_t some = std::size_t{1} << 12;
  for (const InverseLength& kernel : inverse_lengths())
    for (int power = -23; power <= 20; ++power) {
      std::vector<float> expected(some), results(some);
      for (std::size_t i = 0; i < some; ++i) {
        expected[i] = 1 + static_cast<float>(i) * 3 / some;
        results[i] = std::ldexp(expected[i], 2 * power);
      }
      kernel.invert(expected.data(), some);
      kernel.invert(results.data(), some);
      for (float& x : expected) x = std::ldexp(x, -power);
      EXPECT_EQ(results, expected) << kernel.instruction_set << ", 4^" << power;
    }
}

TEST(InverseLength, IsNotFiniteForALengthOfZero) {
  for (const InverseLength& kernel : inverse_lengths()) {
    std::vector<float> numbers(16, 0.0F);
    kernel.invert(numbers.data(), numbers.size());
    for (const float x : numbers) EXPECT_FALSE(std::isfinite(x)) << kernel.instruction_set;
  }
}

}  // namespace
}  // namespace mssim
#endif
