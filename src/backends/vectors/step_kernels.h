#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "backends/interface/backend.h"

namespace mssim {

/// Vector code for one instruction set that steps a `Data` laid out for its lanes.
template <class Data>
struct StepKernel {
  std::size_t lanes;                    ///< numbers per vector; the data must be laid out for it
  const char* instruction_set;          ///< Highway's name for it
  bool exact_roots;                     ///< see inverse_length (lanes-inl.h)
  bool fuses;                           ///< whether multiply-adds are rounded once
  void (*step)(Data& data, int count);  ///< takes `count` steps

  /// As Backend::device.
  std::string device() const { return std::string("cpu ") + instruction_set; }
};

/// The vector code that steps a `Data`, for the instruction sets of this CPU, at least one, the best first.
/// The data's step_*.cpp defines it; if CMakeLists.txt compiles that several times, once for each of the
/// Stages. Throws Unavailable if this CPU supports none of the instruction sets.
template <class Data, std::size_t stages = 1>
std::vector<StepKernel<Data>> compiled_kernels();

/// Integrators with `count` stages, or at least that many for most_stages_apart: their vector code is
/// compiled together, because all integrators together would compile too long.
template <std::size_t count>
struct Stages {
  static constexpr std::size_t most_stages_apart = 3;
  static constexpr bool have(const Integrator& integrator) {
    return std::min(integrator.stage_count, most_stages_apart) == count;
  }
};

/// The compiled kernels for this explicit integrator.
template <class Data>
std::vector<StepKernel<Data>> step_kernels(const Integrator& integrator) {
  if (Stages<1>::have(integrator)) return compiled_kernels<Data, 1>();
  if (Stages<2>::have(integrator)) return compiled_kernels<Data, 2>();
  return compiled_kernels<Data, 3>();
}

/// The best of these kernels with these `roots` and, if one is named, for this instruction set. Throws
/// Unavailable if there is none.
template <class Data>
StepKernel<Data> best_kernel(const std::vector<StepKernel<Data>>& kernels, Roots roots,
                             std::string_view instruction_set = {}) {
  for (const StepKernel<Data>& kernel : kernels)
    if ((roots == Roots::fast || kernel.exact_roots) &&
        (instruction_set.empty() || kernel.instruction_set == instruction_set))
      return kernel;
  if (instruction_set.empty()) throw Unavailable("no vector code for this CPU has exact roots");
  throw Unavailable("the vector code for " + std::string(instruction_set) +
                    (roots == Roots::exact ? " has no exact roots" : " is not for this CPU"));
}

/// The names of the kernels' instruction sets.
template <class Data>
std::vector<std::string_view> instruction_sets_of(const std::vector<StepKernel<Data>>& kernels) {
  std::vector<std::string_view> names;
  for (const StepKernel<Data>& kernel : kernels) names.emplace_back(kernel.instruction_set);
  return names;
}

/// A backend that steps with vector code. `Data` has the nodes: set_state(), state() and `threads` (the
/// number used), and optionally further functions of a backend.
template <class Data>
class VectorBackend final : public Backend {
 public:
  /// Makes the data from the system and the other arguments, at the system's start.
  template <class... Arguments>
  VectorBackend(const StepKernel<Data>& kernel, const System& system, const Arguments&... arguments)
      : kernel_(kernel), data_(system, arguments...) {
    data_.set_state(system.start);
  }

  void set_state(const State& state) override { data_.set_state(state); }
  State state() const override { return data_.state(); }
  void step(int count) override { kernel_.step(data_, count); }
  std::string device() const override { return kernel_.device(); }
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

/// Steps a cloth or bodies with the best instruction set that has options.roots, or with
/// options.instruction_set: a `Cloth` or `Bodies`, constructed from the system, dt in s, lanes, the maximum
/// number of threads and `more`.
template <class Cloth, class Bodies, class... More>
std::unique_ptr<Backend> make_vector_backend(const System& system, double dt_s,
                                             const ExecutionOptions& options, const More&... more) {
  const auto make = [&]<class Data>(std::type_identity<Data>) -> std::unique_ptr<Backend> {
    const StepKernel<Data> kernel =
        best_kernel(compiled_kernels<Data>(), options.roots, options.instruction_set);
    return std::make_unique<VectorBackend<Data>>(kernel, system, dt_s, kernel.lanes,
                                                 static_cast<std::size_t>(options.threads), more...);
  };
  if (std::holds_alternative<GridPatch>(system.topology)) return make(std::type_identity<Cloth>());
  return make(std::type_identity<Bodies>());
}

}  // namespace mssim
