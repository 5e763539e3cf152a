#include "charts/axis_scale.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "text/text.h"

namespace mssim {
namespace {

constexpr int most_ticks = 6;
constexpr double room = 0.05;  // beside the values, as a fraction of what they span

AxisScale with_ticks(double low, double high) { return {low, high, ticks_between(low, high, most_ticks)}; }

/// 10 to the power of `exponent` as people write it, with the sign of multiplication before it.
std::string power_of_ten(int digit, int exponent) {
  constexpr const char* superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = digit == 1 ? "10" : std::to_string(digit) + "·10";
  if (exponent < 0) text += "⁻";
  for (const char figure : std::to_string(std::abs(exponent))) text += superscripts[figure - '0'];
  return text;
}

std::string short_label(int digit, int exponent) {
  if (exponent < 0)
    return "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + std::to_string(digit);
  return grouped(static_cast<std::uint64_t>(digit) *
                 static_cast<std::uint64_t>(std::llround(std::pow(10, exponent))));
}

/// At the given multiples of every `step`-th power of ten.
std::vector<Tick> decade_ticks(double low, double high, std::initializer_list<int> digits, int step) {
  const int first = static_cast<int>(std::floor(std::log10(low))),
            last = static_cast<int>(std::ceil(std::log10(high)));
  const bool short_labels = first >= -4 && last <= 6;
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % step != 0) continue;
    for (const int digit : digits) {
      const double value = digit * std::pow(10.0, exponent);
      if (value >= low && value <= high)
        ticks.push_back({value, short_labels ? short_label(digit, exponent) : power_of_ten(digit, exponent)});
    }
  }
  return ticks;
}

}  // namespace

AxisScale linear_scale(double low, double high) {
  if (low > 0 && low < high / 2) low = 0;
  if (high < 0 && high > low / 2) high = 0;
  double beside = room * (high - low);
  // Of one value, the axis shows what is around it.
  if (!(beside > 1e-8 * std::max(std::abs(low), std::abs(high)))) beside = low == 0 ? 1 : std::abs(low) / 2;
  return with_ticks(low == 0 ? 0 : low - beside, high == 0 && low < 0 ? 0 : high + beside);
}

AxisScale scale_from_zero(double low, double high) {
  low = std::min(low, 0.0);
  high = std::max(high, 0.0);
  if (low == high) high = 1;
  const double beside = room * (high - low);
  return with_ticks(low == 0 ? 0 : low - beside, high == 0 ? 0 : high + beside);
}

AxisScale logarithmic_scale(double low, double high) {
  const double decades = std::log10(high) - std::log10(low);
  const double factor = std::pow(10.0, std::clamp(room * decades, 0.1, 1.0));
  low /= factor;
  high *= factor;
  std::vector<Tick> ticks;
  const int step = static_cast<int>(std::ceil((decades + 1) / (most_ticks + 2)));
  for (const auto& digits : {std::initializer_list<int>{1}, {1, 3}, {1, 2, 5}})
    if (ticks.size() < 3) ticks = decade_ticks(low, high, digits, step);
  if (ticks.size() < 2) ticks = ticks_between(low, high, most_ticks);
  return {low, high, std::move(ticks)};
}

}  // namespace mssim
