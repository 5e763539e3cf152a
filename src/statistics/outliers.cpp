#include "statistics/outliers.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "statistics/statistics.h"

namespace mssim {

Quartiles quartiles(std::span<const double> samples) {
  const std::vector<double> sorted = ascending(samples);
  const auto count = static_cast<double>(sorted.size());
  const auto sample_number = [&](double number) {
    const double at = std::clamp(number, 1.0, count) - 1;
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
  };
  return {sample_number((count + 1) / 4), sample_number(3 * (count + 1) / 4)};
}

std::string_view name_of(Outlier outlier) {
  switch (outlier) {
    case Outlier::mild:
      return "mild";
    case Outlier::extreme:
      return "extreme";
    case Outlier::no:
      break;
  }
  return "";
}

std::vector<Outlier> outliers(std::span<const double> samples) {
  const Quartiles middle = quartiles(samples);
  const double range = middle.third - middle.first;
  std::vector<Outlier> labels;
  std::ranges::transform(samples, std::back_inserter(labels), [&](double sample) {
    const double outside = std::max(middle.first - sample, sample - middle.third);
    if (outside > 3 * range) return Outlier::extreme;
    return outside > 1.5 * range ? Outlier::mild : Outlier::no;
  });
  return labels;
}

}  // namespace mssim
