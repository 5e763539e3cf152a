#include "geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mssim {
namespace {

/// The length of the hull's side that is met first when going along the sorted points.
template <class Iterator>
double half_perimeter(Iterator begin, Iterator end) {
  std::vector<PlanPoint> chain;
  const auto turns_left = [](const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
    return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x) > 0;
  };
  for (auto point = begin; point != end; ++point) {
    while (chain.size() >= 2 && !turns_left(chain[chain.size() - 2], chain.back(), *point)) chain.pop_back();
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
  std::sort(points.begin(), points.end(),
            [](const PlanPoint& a, const PlanPoint& b) { return std::pair(a.x, a.z) < std::pair(b.x, b.z); });
  return half_perimeter(points.begin(), points.end()) + half_perimeter(points.rbegin(), points.rend());
}

}  // namespace mssim
