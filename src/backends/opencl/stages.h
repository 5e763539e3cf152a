#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backends/devices/device.h"
#include "backends/devices/device_queue.h"
#include "backends/interface/backend.h"
#include "text/text.h"

namespace mssim {

/// Layout of a topology's nodes in the buffer of a pair.
struct PairLayout {
  std::size_t floats;             ///< in the buffer
  std::vector<std::size_t> node;  ///< [nodes] offset of the node's x
  /// Copies of nodes: offset and node. Kernels keep them up to date.
  std::vector<std::pair<std::size_t, std::size_t>> copies;
  std::size_t step;         ///< floats from one component of a vector to the next
  std::size_t to_velocity;  ///< floats from a node's x to its velocity

  /// Six components at equal distances, and no nodes yet.
  PairLayout(std::size_t of_buffer, std::size_t component_step)
      : floats(of_buffer), step(component_step), to_velocity(3 * component_step) {}
};

/// Common part of all OpenCL backends: a device, the kernels' arguments, and two sets of launches. Buffers
/// swap roles from one launch to the next, so every other launch is `swapped`.
class OpenclBackend : public Backend {
 public:
  std::string device() const override { return queue_.label(); }
  int threads() const override { return queue_.threads(); }
  bool runs_on_host() const override { return queue_.runs_on_host(); }

 protected:
  /// Throws Unsupported unless the device can hold `buffers`, sizes in bytes. The step parameters are the
  /// first argument.
  OpenclBackend(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
                DeviceMemory memory, const PairLayout& layout, std::span<const std::uint64_t> buffers);

  /// Adds an argument to every kernel: a buffer with a copy of these bytes.
  void add_argument(std::string_view bytes) { arguments_.push_back(queue_.copy_of(std::span(bytes))); }
  /// Adds a launch whose kernel object keeps its arguments: the common ones from `argument` on.
  void add_launch(bool swapped, cl::Kernel kernel, cl_uint argument, const WorkItems& items);

  /// Writes the state into a buffer of this layout that begins `first` floats into `buffer`; ghosts have
  /// their own layout, and nothing is read from them. This and read_state throw std::runtime_error if the
  /// driver fails.
  void write_state(const OpenclBuffer<float>& buffer, const PairLayout& layout, const State& state,
                   std::size_t first = 0) const;
  State read_state(const OpenclBuffer<float>& buffer) const;

  PairLayout layout_;  ///< of the state
  DeviceQueue queue_;
  std::vector<OpenclBuffer<char>> arguments_;
  std::array<std::vector<Launch>, 2> launches_;  ///< [swapped]
  /// Whether the next launch is swapped: the state is in the pair `next`, or ghosts are read from the second
  /// half of theirs.
  bool swapped_ = false;
};

/// Data of a system for the kernels, one per stage of the integrator.
struct StageKernels {
  PairLayout layout;
  /// Arguments of every kernel after its pairs (stage_arguments) and the step parameters. They are copied.
  std::vector<std::string_view> arguments;
  std::string program;  ///< text
  WorkItems items;
  std::optional<std::uint64_t> stored_springs = {};  ///< Backend::stored_springs
};

/// Steps a system with one kernel per stage of the integrator, all steps queued in order: the `opencl`
/// backend, except for the walk over a cloth (cloth.h).
class OpenclStages final : public OpenclBackend {
 public:
  /// Throws Unsupported unless the device can hold the integrator's pairs and the arguments.
  OpenclStages(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
               DeviceMemory memory, const StageKernels& kernels);

  void set_state(const State& state) override { write_state(arrays(Pair::state, swapped_), layout_, state); }
  void step(int count) override;
  State state() const override { return read_state(arrays(Pair::state, swapped_)); }
  std::optional<std::uint64_t> stored_springs() const override { return stored_springs_; }

 private:
  /// The arrays of `pair`; `state` and `next` swap roles after every step.
  const OpenclBuffer<float>& arrays(Pair pair, bool swapped) const;

  std::array<std::optional<OpenclBuffer<float>>, pair_kinds> pairs_;  // [Pair], the required ones
  std::optional<std::uint64_t> stored_springs_;
};

}  // namespace mssim
