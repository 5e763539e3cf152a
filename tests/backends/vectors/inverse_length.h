#pragma once

#include "backends/vectors/instruction_sets.h"
#include "tests/support/testing.h"

namespace mssim {

/// The reciprocal roots of one instruction set.
struct InverseLength {
  const char* instruction_set;
  bool exact;                                         ///< as it says of itself
  void (*invert)(float* numbers, std::size_t count);  ///< replaces each; as many as a multiple of 16
};

/// Those of this processor.
std::vector<InverseLength> inverse_lengths();

}  // namespace mssim
