#pragma once

#include <cstddef>

namespace mssim {

/// When pairs are looked at while more of them are being measured, and what each look may spend.
///
/// Who tests again after every round, and stops once there is a difference, finds one sooner or later where
/// there is none. Therefore pairs are looked at after 10, 15, 22, 33, ... of them only, half as many more
/// each time, and the k-th look may err in 1 / (k (k + 1)) of the cases in which a single one might. The
/// shares of all looks, however many there will be, add up to 1, and with them the probabilities to err: p
/// over the share is a p-value, and the interval of that much smaller an error holds the truth, whenever and
/// for whatever reason one stops (a repeated p-value, a repeated confidence interval). Nothing is asked of
/// how looks depend on each other.
///
/// Where the measurement ends between two looks, for a reason that is not in the pairs (a time budget), the
/// next look is taken then. Looks may come at times that were not planned, if what was seen does not decide
/// over them.
///
/// Sources: K. K. G. Lan, D. L. DeMets, Discrete sequential boundaries for clinical trials, Biometrika 70
/// (1983), 659-663 (spending an error over looks); C. Jennison, B. W. Turnbull, Statistical approaches to
/// interim monitoring of medical trials, Statistical Science 5 (1990), 299-317 (repeated p-values and
/// confidence intervals).
struct Look {
  std::size_t pairs;  ///< when it is due
  double fraction;    ///< of the error that a single look might make
};

/// Pairs of the first look. With half of the error ten are the fewest that can be significant at 1 % though
/// one of them, the one that differs least, disagrees.
inline constexpr std::size_t first_look_pairs = 10;

/// The look at so many pairs: the first that is due then or later.
Look look_at(std::size_t pairs);

}  // namespace mssim
