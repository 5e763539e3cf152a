#pragma once

#include <string>
#include <vector>

namespace mssim {

/// Says the first few of these on stderr, in a line each, and how many more there are.
void tell_first(const std::vector<std::string>& sentences);

}  // namespace mssim
