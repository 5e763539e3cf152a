#pragma once

#include <vector>

namespace mssim {

/// A smooth curve through given values that is monotone between each two of them: it never overshoots.
/// Piecewise cubic with the slopes of Fritsch and Butland ("A method for constructing local monotone
/// piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5, 1984).
class MonotoneCurve {
 public:
  /// `positions` ascend strictly; there are as many `values`, two or more.
  MonotoneCurve(std::vector<double> positions, std::vector<double> values);

  /// The value at a position; beyond the ends it is that of the end.
  double operator()(double position) const;

 private:
  std::vector<double> positions_, values_, slopes_;
};

}  // namespace mssim
