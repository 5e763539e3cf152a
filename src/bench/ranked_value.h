#pragma once

#include <cstddef>
#include <functional>

namespace mssim {

/// The rank-th smallest (from 1) of values that are too many to be written down. `count_up_to(v)` says how
/// many of them are at most v; all lie in [low, high].
double ranked_value(std::size_t rank, double low, double high,
                    const std::function<std::size_t(double)>& count_up_to);

/// The median of `count` such values.
double ranked_median(std::size_t count, double low, double high,
                     const std::function<std::size_t(double)>& count_up_to);

}  // namespace mssim
