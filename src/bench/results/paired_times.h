#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/results/comparison.h"

namespace mssim {

/// Times of one combination by two programs, which took turns: a pair a round. Where the programs are alike,
/// either time of a pair is as likely to be the longer, whatever the machine did in that round: that is all
/// that the looks and their tests take for granted.
struct PairedTimes {
  std::string scene, backend, integrator;
  std::vector<double> base_ms, new_ms;  ///< [rounds]
  std::string lost;  ///< why NEW has no verified time though BASE has; then it is not measured any further
};

/// Whether more rounds are not worth their time: a look at the pairs is due (look_at) and finds the whole
/// interval of the ratio within the threshold, or beyond it and the change significant; or NEW is lost. Where
/// nothing has changed, at most one of a hundred comparisons ends so with a change, however many rounds there
/// may be, and where something has, at most one of twenty with an interval that misses it.
bool is_settled(const PairedTimes& times, double threshold);

/// The verdict on pairs: as on independent samples (comparison.h), by signed ranks; undecided below
/// first_look_pairs. The interval and p are those of the look at so many pairs, so that they hold although
/// the pairs were looked at before. To be asked for pairs that are settled, or when time is up. Throws
/// std::invalid_argument for a time that is not finite and positive, and for no rounds unless NEW is lost.
ComparedRow compare_pairs(const PairedTimes& times, double threshold);

}  // namespace mssim
