#include "geometry/geometry.h"

#include <fmt/core.h>

#include <cassert>
#include <utility>

namespace mssim {

std::string shown(double computed) { return fmt::format("{:.12g}", computed); }

std::string place(const Vec3d& point) {
  return fmt::format("({}, {}, {})", shown(point.x), shown(point.y), shown(point.z));
}

namespace {

/// Length of the chain of hull edges on one side, along the sorted points.
template <class Iterator>
double half_perimeter(Iterator begin, Iterator end) {
  std::vector<PlanPoint> chain;
  for (auto point = begin; point != end; ++point) {
    while (chain.size() >= 2 && !(side_of(chain[chain.size() - 2], chain.back(), *point) > 0))
      chain.pop_back();
    chain.push_back(*point);
  }
  double sum = 0;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const double x = chain[i].x - chain[i - 1].x;
    const double z = chain[i].z - chain[i - 1].z;
    sum += std::sqrt(x * x + z * z);
  }
  return sum;
}

}  // namespace

double hull_perimeter(std::vector<PlanPoint> points) {
  std::ranges::sort(points, {}, [](const PlanPoint& point) { return std::pair(point.x, point.z); });
  return half_perimeter(points.begin(), points.end()) + half_perimeter(points.rbegin(), points.rend());
}

MonotoneCurve::MonotoneCurve(std::vector<double> positions, std::vector<double> values)
    : positions_(std::move(positions)), values_(std::move(values)), slopes_(positions_.size()) {
  assert(positions_.size() >= 2 && values_.size() == positions_.size());
  const std::size_t last = positions_.size() - 1;
  const auto width = [&](std::size_t i) { return positions_[i + 1] - positions_[i]; };
  const auto secant = [&](std::size_t i) { return (values_[i + 1] - values_[i]) / width(i); };
  slopes_[0] = secant(0);
  slopes_[last] = secant(last - 1);
  for (std::size_t i = 1; i < last; ++i) {
    const double before = secant(i - 1);
    const double behind = secant(i);
    if (before * behind <= 0) continue;  // local extremum: the curve is level there
    const double w_before = 2 * width(i) + width(i - 1);
    const double w_behind = width(i) + 2 * width(i - 1);
    slopes_[i] = (w_before + w_behind) / (w_before / before + w_behind / behind);
  }
}

double MonotoneCurve::operator()(double position) const {
  if (position <= positions_.front()) return values_.front();
  if (position >= positions_.back()) return values_.back();
  const auto above = std::upper_bound(positions_.begin(), positions_.end(), position);
  const auto i = static_cast<std::size_t>(above - positions_.begin()) - 1;
  const double h = positions_[i + 1] - positions_[i];
  const double t = (position - positions_[i]) / h;
  const double s = 1 - t;
  return s * s * (1 + 2 * t) * values_[i] + t * t * (1 + 2 * s) * values_[i + 1] +
         s * t * h * (s * slopes_[i] - t * slopes_[i + 1]);
}

}  // namespace mssim
