#include "guide/pareto_front.h"

#include <algorithm>

namespace mssim {
namespace {

bool beats(const WorkPoint& a, const WorkPoint& b) {
  const double time = a.seconds_a_second(), other_time = b.seconds_a_second();
  const double error = *a.position_error, other_error = *b.position_error;
  return time <= other_time && error <= other_error && (time < other_time || error < other_error);
}

}  // namespace

void mark_pareto_front(std::span<WorkPoint> points) {
  for (WorkPoint& point : points)
    point.on_front = point.counts() && std::ranges::none_of(points, [&](const WorkPoint& other) {
                       return other.counts() && beats(other, point);
                     });
}

}  // namespace mssim
