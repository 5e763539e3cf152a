#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "backends/interface/backend.h"

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

/// The vector code that steps a `Data`, for the instruction sets of this processor, at least one, the best
/// first. The step_*.cpp of the data defines it; where CMakeLists.txt compiles that several times, for each
/// of the Stages. Throws Unavailable where this processor has none of the instruction sets.
template <class Data, std::size_t stages = 1>
std::vector<StepKernel<Data>> compiled_kernels();

/// Integrators of so many stages, or of more if it is most_stages_apart: those whose vector code is compiled
/// together. All together would take long to compile.
template <std::size_t count>
struct Stages {
  static constexpr std::size_t most_stages_apart = 3;
  static constexpr bool have(const Integrator& integrator) {
    return std::min(integrator.stage_count, most_stages_apart) == count;
  }
};

/// Those of the compiled kernels that take this explicit integrator's steps.
template <class Data>
std::vector<StepKernel<Data>> step_kernels(const Integrator& integrator) {
  if (Stages<1>::have(integrator)) return compiled_kernels<Data, 1>();
  if (Stages<2>::have(integrator)) return compiled_kernels<Data, 2>();
  return compiled_kernels<Data, 3>();
}

/// The best of these kernels that has `roots`. Throws Unavailable where none has.
template <class Data>
StepKernel<Data> best_kernel(const std::vector<StepKernel<Data>>& kernels, Roots roots) {
  for (const StepKernel<Data>& kernel : kernels)
    if (roots == Roots::fast || kernel.exact_roots) return kernel;
  throw Unavailable("no vector code for this processor has exact roots");
}

/// The kernel for an instruction set. Throws std::invalid_argument where it is not among these.
template <class Data>
StepKernel<Data> kernel_named(const std::vector<StepKernel<Data>>& kernels,
                              std::string_view instruction_set) {
  for (const StepKernel<Data>& kernel : kernels)
    if (kernel.instruction_set == instruction_set) return kernel;
  throw std::invalid_argument("openmp has no vector code for " + std::string(instruction_set) +
                              " that this processor can run");
}

/// The instruction sets of kernels.
template <class Data>
std::vector<std::string_view> instruction_sets_of(const std::vector<StepKernel<Data>>& kernels) {
  std::vector<std::string_view> names;
  for (const StepKernel<Data>& kernel : kernels) names.emplace_back(kernel.instruction_set);
  return names;
}

/// A backend whose steps are vector code. `Data` holds the nodes: it has set_state(), state() and `threads`,
/// how many it takes, and may have what else a backend tells.
template <class Data>
class VectorBackend final : public Backend {
 public:
  /// Makes the data of the system and the other arguments, at the system's start.
  template <class... Arguments>
  VectorBackend(const StepKernel<Data>& kernel, const System& system, const Arguments&... arguments)
      : kernel_(kernel), data_(system, arguments...) {
    data_.set_state(system.start);
  }

  void set_state(const State& state) override { data_.set_state(state); }
  State state() const override { return data_.state(); }
  void step(int count) override { kernel_.step(data_, count); }
  std::string device() const override { return std::string("cpu ") + kernel_.instruction_set; }
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
  const StepKernel<Data> kernel_;
  Data data_;
};

/// Steps a cloth or bodies with the vector code for an instruction set: with a `Cloth` or `Bodies`, which are
/// made of the system, dt in s, lanes, the most threads and `more`.
template <class Cloth, class Bodies, class... More>
std::unique_ptr<Backend> make_vector_backend(const System& system, double dt_s, int threads,
                                             std::string_view instruction_set, const More&... more) {
  const auto make = [&]<class Data>(std::type_identity<Data>) -> std::unique_ptr<Backend> {
    const StepKernel<Data> kernel = kernel_named(compiled_kernels<Data>(), instruction_set);
    return std::make_unique<VectorBackend<Data>>(kernel, system, dt_s, kernel.lanes,
                                                 static_cast<std::size_t>(threads), more...);
  };
  if (std::holds_alternative<GridPatch>(system.topology)) return make(std::type_identity<Cloth>());
  return make(std::type_identity<Bodies>());
}

/// The same with the best instruction set that has options.roots.
template <class Cloth, class Bodies, class... More>
std::unique_ptr<Backend> make_vector_backend(const System& system, double dt_s,
                                             const ExecutionOptions& options, const More&... more) {
  return make_vector_backend<Cloth, Bodies>(
      system, dt_s, options.threads, best_kernel(compiled_kernels<Cloth>(), options.roots).instruction_set,
      more...);
}

}  // namespace mssim
