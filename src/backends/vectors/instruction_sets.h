#pragma once

// What Highway compiles vector code for, and what of it this processor can run. Highway reads the macro below
// when it is included, so this header comes first.
#ifdef HIGHWAY_HWY_DETECT_TARGETS_H_
#error "backends/vectors/instruction_sets.h must be included before Highway"
#endif

// On x86-64: SSE4 (4 lanes), AVX2 (8), AVX-512 (16, "AVX3" to Highway), and for a processor before SSE4 of
// 2007 plain floats, one lane: Highway has no vectors of SSE2 alone, and the year between SSSE3 and SSE4 is
// not worth a fifth of the time that vector code takes to compile. On arm64 NEON (4). Not Arm's SVE: a vector
// whose length is known only at run time cannot be a member of a struct, as Lanes needs it, and the phones
// that have SVE have vectors of 128 bits, no longer than NEON's.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/targets.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mssim {

/// The kernels in one of Highway's dispatch tables (functions that return a kernel) that this processor can
/// run, the best first, at least one. Unlike HWY_DYNAMIC_DISPATCH, which knows only the best.
template <class Kernel, std::size_t size>
std::vector<Kernel> kernels_of_this_processor(Kernel (*const (&table)[size])()) {
  std::vector<Kernel> kernels;
  // Lower bits are better. The static target is what all other code is compiled for.
  for (std::int64_t rest = (HWY_SUPPORTED_TARGETS & HWY_TARGETS) | HWY_STATIC_TARGET; rest != 0;
       rest &= rest - 1) {
    hwy::ChosenTarget target;
    target.Update(rest & -rest);
    kernels.push_back(table[size == 1 ? 0 : target.GetIndex()]());
  }
  return kernels;
}

}  // namespace mssim
