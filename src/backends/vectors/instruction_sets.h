#pragma once

// The instruction sets for which Highway compiles vector code, and those that this CPU can run. A file of
// vector code (step_*.cpp) is compiled once per instruction set: hwy/foreach_target.h includes it again for
// each. Highway reads the macro below when it is included, so include this header first.
#ifdef HIGHWAY_HWY_DETECT_TARGETS_H_
#error "backends/vectors/instruction_sets.h must be included before Highway"
#endif

// On x86-64: SSE4 (4 lanes of floats), AVX2 (8), AVX-512 (16, Highway's "AVX3"). Highway's SSE4 is SSE4.2
// with AES and carry-less multiplication, which a few CPUs up to about 2013 lack; plain floats for them would
// take a quarter of the compile time of vector code. No targets beyond AVX3 (lower bits): newer versions of
// Highway would compile the same code again for Zen 4 and for Sapphire Rapids. On arm64 NEON (4), not Arm's
// SVE: a vector whose length is known only at run time cannot be a struct member, as Lanes requires, and
// phones with SVE have vectors of 128 bits, no longer than NEON's. On other CPUs the compiler's baseline, or
// plain floats, one lane.
#define HWY_DISABLED_TARGETS ((HWY_AVX3 - 1) | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#if defined(__x86_64__) && !defined(__SSE4_2__)
#define HWY_BASELINE_TARGETS HWY_SSE4
#endif
#include <hwy/targets.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/vectors/step_kernels.h"

// The Stages that a file of vector code is compiled for; CMakeLists.txt compiles some again for others.
#ifndef MSSIM_STAGES
#define MSSIM_STAGES 1
#endif
// The type of its numbers, float or double, and the namespace of that code in HWY_NAMESPACE.
#ifndef MSSIM_REAL
#define MSSIM_REAL float
#endif
#define MSSIM_PRECISION_OF(real) in_##real
#define MSSIM_PRECISION_NAMED(real) MSSIM_PRECISION_OF(real)
#define MSSIM_PRECISION MSSIM_PRECISION_NAMED(MSSIM_REAL)

namespace mssim {

/// The kernels in one of Highway's dispatch tables (functions that return a kernel) that this CPU can run,
/// the best first. (HWY_DYNAMIC_DISPATCH gives only the best.) Throws Unavailable if there is none.
template <class Kernel, std::size_t size>
std::vector<Kernel> kernels_of_this_processor(Kernel (*const (&table)[size])()) {
  std::vector<Kernel> kernels;
  // Lower bits are better.
  for (std::int64_t rest = HWY_SUPPORTED_TARGETS & HWY_TARGETS; rest != 0; rest &= rest - 1) {
    hwy::ChosenTarget target;
    target.Update(rest & -rest);
    kernels.push_back(table[size == 1 ? 0 : target.GetIndex()]());
  }
  if (kernels.empty()) throw Unavailable("this CPU lacks SSE4.2 or AES, the minimum for vector code");
  return kernels;
}

/// The kernels for a `Data`; MSSIM_COMPILED_KERNELS defines it.
template <class Data, std::size_t stages>
struct CompiledHere;

template <class Data, std::size_t stages>
std::vector<StepKernel<Data>> compiled_kernels() {
  return CompiledHere<Data, stages>::kernels();
}

}  // namespace mssim

/// Defines compiled_kernels<Data, MSSIM_STAGES>(), in mssim and once for all instruction sets, from functions
/// `kernel` in HWY_NAMESPACE that return a StepKernel<Data>.
// NOLINTBEGIN(bugprone-macro-parentheses): a type has no parentheses
#define MSSIM_COMPILED_KERNELS(Data, kernel)                        \
  HWY_EXPORT(kernel);                                               \
  template <>                                                       \
  struct CompiledHere<Data, MSSIM_STAGES> {                         \
    static std::vector<StepKernel<Data>> kernels() {                \
      return kernels_of_this_processor(HWY_DISPATCH_TABLE(kernel)); \
    }                                                               \
  };                                                                \
  template std::vector<StepKernel<Data>> compiled_kernels<Data, MSSIM_STAGES>();
// NOLINTEND(bugprone-macro-parentheses)
