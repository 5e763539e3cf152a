#include "bench/ranked_value.h"

#include <numeric>

namespace mssim {

double ranked_value(std::size_t rank, double low, double high,
                    const std::function<std::size_t(double)>& count_up_to) {
  if (count_up_to(low) >= rank) return low;
  // Halved until no number lies between: then `high` is the smallest that reaches the rank, so the value.
  for (double middle = std::midpoint(low, high); low < middle && middle < high;
       middle = std::midpoint(low, high))
    (count_up_to(middle) >= rank ? high : low) = middle;
  return high;
}

double ranked_median(std::size_t count, double low, double high,
                     const std::function<std::size_t(double)>& count_up_to) {
  const double upper = ranked_value(count / 2 + 1, low, high, count_up_to);
  return count % 2 == 1 ? upper : std::midpoint(ranked_value(count / 2, low, high, count_up_to), upper);
}

}  // namespace mssim
