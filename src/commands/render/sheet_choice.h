#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mssim {

/// `count` of `frames`, evenly spread from the first to the last; all where there are no more.
std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count);

}  // namespace mssim
