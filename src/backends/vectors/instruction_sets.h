#pragma once

// What Highway compiles vector code for, and what of it this processor can run. Highway reads the macro below
// when it is included, so this header comes first.
#ifdef HIGHWAY_HWY_DETECT_TARGETS_H_
#error "backends/vectors/instruction_sets.h must be included before Highway"
#endif

// On x86-64: SSE4 (4 lanes), AVX2 (8), AVX-512 (16, "AVX3" to Highway). By SSE4 Highway means SSE4.2 with AES
// and carry-less multiplication, which a few processors up to about 2013 lack; plain floats for them would be
// a quarter of the time that vector code takes to compile. Not what Highway has beyond AVX3, in lower bits:
// newer versions of it would compile the same code for Zen 4 and for Sapphire Rapids again. On arm64 NEON
// (4). Not Arm's SVE: a vector whose length is known only at run time cannot be a member of a struct, as
// Lanes needs it, and the phones that have SVE have vectors of 128 bits, no longer than NEON's. On any other
// processor what its compiler takes for granted, or plain floats, one lane.
#define HWY_DISABLED_TARGETS ((HWY_AVX3 - 1) | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#if defined(__x86_64__) && !defined(__SSE4_2__)
#define HWY_BASELINE_TARGETS HWY_SSE4
#endif
#include <hwy/targets.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"

// The Stages that a file of vector code is compiled for; CMakeLists.txt compiles some again for others.
#ifndef MSSIM_STAGES
#define MSSIM_STAGES 1
#endif

namespace mssim {

/// Vector code for one instruction set, which steps a `Data` laid out for its lanes.
template <class Data>
struct StepKernel {
  std::size_t lanes;                    ///< floats in a vector, for which the data must be laid out
  const char* instruction_set;          ///< Highway's name for it
  bool exact_roots;                     ///< as inverse_length (lanes-inl.h) says
  bool fuses;                           ///< the same of multiplications and additions
  void (*step)(Data& data, int count);  ///< takes `count` steps
};

/// Integrators of so many stages, or of more if it is most_stages_apart: those whose vector code is compiled
/// together. All together would take long to compile.
template <std::size_t count>
struct Stages {
  static constexpr std::size_t most_stages_apart = 3;
  static constexpr bool have(const Integrator& integrator) {
    return std::min(integrator.stage_count, most_stages_apart) == count;
  }
};

/// What `kernels` returns for the Stages that have the integrator.
template <class Kernels>
auto kernels_of_stages(const Integrator& integrator, const Kernels& kernels) {
  if (Stages<1>::have(integrator)) return kernels(Stages<1>());
  if (Stages<2>::have(integrator)) return kernels(Stages<2>());
  return kernels(Stages<3>());
}

/// The kernels in one of Highway's dispatch tables (functions that return a kernel) that this processor can
/// run, the best first. Unlike HWY_DYNAMIC_DISPATCH, which knows only the best. Throws Unavailable where
/// there is none.
template <class Kernel, std::size_t size>
std::vector<Kernel> kernels_of_this_processor(Kernel (*const (&table)[size])()) {
  std::vector<Kernel> kernels;
  // Lower bits are better.
  for (std::int64_t rest = HWY_SUPPORTED_TARGETS & HWY_TARGETS; rest != 0; rest &= rest - 1) {
    hwy::ChosenTarget target;
    target.Update(rest & -rest);
    kernels.push_back(table[size == 1 ? 0 : target.GetIndex()]());
  }
  if (kernels.empty())
    throw Unavailable("this processor lacks SSE4.2 or AES, the least that vector code is compiled for");
  return kernels;
}

/// The best of these kernels that has `roots`. Throws Unavailable where none has.
template <class Kernel>
Kernel best_kernel(const std::vector<Kernel>& kernels, Roots roots) {
  for (const Kernel& kernel : kernels)
    if (roots == Roots::fast || kernel.exact_roots) return kernel;
  throw Unavailable("no vector code for this processor has exact roots");
}

/// A backend whose steps are vector code. `Data` holds the nodes: it has set_state(), state() and `threads`,
/// how many it takes, and may have what else a backend tells.
template <class Data>
class VectorBackend final : public Backend {
 public:
  using Step = void (*)(Data& data, int count);

  /// Makes the data of the system and the other arguments, at the system's start.
  template <class... Arguments>
  VectorBackend(std::string device, Step take_steps, const System& system, const Arguments&... arguments)
      : device_(std::move(device)), step_(take_steps), data_(system, arguments...) {
    data_.set_state(system.start);
  }
  template <class... Arguments>
  VectorBackend(const StepKernel<Data>& kernel, const System& system, const Arguments&... arguments)
      : VectorBackend(std::string("cpu ") + kernel.instruction_set, kernel.step, system, arguments...) {}

  void set_state(const State& state) override { data_.set_state(state); }
  State state() const override { return data_.state(); }
  void step(int count) override { step_(data_, count); }
  std::string device() const override { return device_; }
  int threads() const override { return static_cast<int>(data_.threads); }
  int steps_per_pass() const override {
    if constexpr (requires { data_.steps_per_pass; }) return static_cast<int>(data_.steps_per_pass);
    return 0;
  }
  std::optional<std::uint64_t> stored_springs() const override {
    if constexpr (requires { data_.stored_springs(); }) return data_.stored_springs();
    return std::nullopt;
  }
  std::string note() const override {
    if constexpr (requires { data_.note(); }) return data_.note();
    return {};
  }

 private:
  const std::string device_;
  const Step step_;
  Data data_;
};

}  // namespace mssim
