#pragma once

#include <string>
#include <vector>

namespace mssim {

/// A number at a scale, and how it is written.
struct Tick {
  double value;
  std::string label;
};

/// The multiples of 1, 2 or 5 times a power of ten from `low` to `high`: at most `most`, which is positive,
/// and at least two if `most` is at least 5. `low` alone where `high` is the same to nine digits. Throws
/// std::invalid_argument unless `low`, `high` and their distance are finite and they are in order.
std::vector<Tick> ticks_between(double low, double high, int most);

}  // namespace mssim
