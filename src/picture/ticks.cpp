#include "picture/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "text/text.h"

namespace mssim {
namespace {

/// All of a scale with the same digits behind the point (as many as 10^exponent has), and a minus as wide as
/// a plus.
std::string tick_label(double value, int exponent) {
  if (value == 0) return "0";
  if (value < 0) return "−" + tick_label(-value, exponent);
  if (exponent < -6 || value >= 1e9) return decimal(value);
  return exponent < 0 ? fixed_decimal(value, -exponent)
                      : grouped(static_cast<std::uint64_t>(std::llround(value)));
}

/// mantissa * 10^exponent, the nearest number where both factors are exact.
double decimal_product(double mantissa, int exponent) {
  return exponent < 0 ? mantissa / std::pow(10.0, -exponent) : mantissa * std::pow(10.0, exponent);
}

}  // namespace

std::vector<Tick> ticks_between(double low, double high, int most) {
  const double distance = high - low;
  if (!std::isfinite(distance) || distance < 0)
    throw std::invalid_argument("a scale goes from a number to one that is not less");
  // Multiples of smaller steps could not be counted, nor could steps below the smallest numbers.
  if (distance <= 1e-9 * std::max(std::abs(low), std::abs(high)) || distance < 1e-290)
    return {{low, (low < 0 ? "−" : "") + decimal(std::abs(low))}};
  // Ends that a rounding has moved across a multiple still have it.
  const double slack = 1e-9;
  const int largest = static_cast<int>(std::floor(std::log10(distance)));
  for (int exponent = largest - 2;; ++exponent)
    for (const int digit : {1, 2, 5}) {
      const double step = decimal_product(digit, exponent);
      const double first = std::ceil(low / step - slack), last = std::floor(high / step + slack);
      if (last - first + 1 > most) continue;
      std::vector<Tick> ticks;
      for (double multiple = first; multiple <= last; ++multiple) {
        const double value = decimal_product(multiple * digit, exponent);
        ticks.push_back({value, tick_label(value, exponent)});
      }
      return ticks;
    }
}

}  // namespace mssim
