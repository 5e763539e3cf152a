#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/comparison.h"

namespace mssim {

/// Times of one combination by two programs, which took turns: a pair a round.
struct PairedTimes {
  std::string scene, backend, integrator;
  std::vector<double> base_ms, new_ms;  ///< [rounds]
  std::string lost;  ///< why NEW has no verified time though BASE has; then it is not measured any further
};

/// Fewer pairs cannot be significant: all on one side have a probability of 2 / 2^n.
inline constexpr std::size_t fewest_pairs = 8;

/// Whether more rounds are not worth their time: the 95 % interval of the ratio is narrower than the
/// threshold, or NEW is lost. How the ratio turned out is not asked, so that stopping does not favour an
/// answer.
bool is_settled(const PairedTimes& times, double threshold);

/// The verdict on pairs: as on independent samples (comparison.h), by signed ranks; undecided below
/// fewest_pairs. Throws std::invalid_argument for a time that is not finite and positive, and for no rounds
/// unless NEW is lost.
ComparedRow compare_pairs(const PairedTimes& times, double threshold);

}  // namespace mssim
