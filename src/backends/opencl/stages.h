#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "backends/devices/buffer.h"
#include "backends/devices/device.h"
#include "backends/devices/device_queue.h"
#include "backends/interface/backend.h"
#include "backends/interface/surroundings.h"
#include "kernels/step_parameters.h"

namespace mssim {

/// How a topology's nodes lie in the buffer of a pair.
struct PairLayout {
  std::size_t floats = 0;         ///< in the buffer
  std::vector<std::size_t> node;  ///< [nodes] where the node's numbers begin
  /// Where a node's numbers stand besides: where they begin, and the node. Kernels keep them up to date.
  std::vector<std::pair<std::size_t, std::size_t>> copies;
  /// Floats that repeat some of a pair's nodes in a buffer of their own, where pairs share memory, and as
  /// above where they stand.
  std::size_t ghost_floats = 0;
  std::vector<std::pair<std::size_t, std::size_t>> ghosts;
  std::array<std::size_t, 6> component{};  ///< from there on x, y, z, u, v, w
};

/// Steps a system by one kernel per stage of the integrator, all steps queued one behind the other: what the
/// `opencl` backend does whatever the topology. A derived class says how nodes lie in memory, gives the
/// program and the arguments that its kernels take, and then calls `prepare`.
class OpenclStages : public Backend {
 public:
  void set_state(const State& state) override;
  void step(int count) override;
  State state() const override;
  std::string device() const override { return queue_.label(); }
  int threads() const override { return queue_.threads(); }
  bool runs_on_host() const override { return queue_.runs_on_host(); }

 protected:
  /// Pairs that share memory (`storage`) have ghosts instead of it for what is gathered while it is written:
  /// kernels then take, after the pairs, the ghosts of every kind of pair and an int, 1 after every second
  /// step, when those of state and next have changed roles. Throws Unsupported unless the device can hold
  /// the integrator's pairs and `others`, all bytes.
  OpenclStages(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
               DeviceMemory memory, Storage storage, PairLayout layout, std::vector<std::uint64_t> others);

  /// The next argument of every kernel: a buffer with a copy of `values`, or of this size. The step
  /// parameters are there from the beginning.
  template <class T>
  void add_argument(std::span<const T> values) {
    arguments_.push_back(queue_.copy_of(std::as_bytes(values)));
  }
  void add_buffer(std::size_t bytes) { arguments_.push_back(queue_.array<std::byte>(bytes)); }

  /// Builds the program and warms up; then stands at `start`.
  void prepare(const std::string& program_text, const WorkItems& items, const State& start);

 private:
  /// The arrays that hold `pair`.
  const OpenclBuffer<float>& arrays(Pair pair, bool swapped) const;

  const Integrator& integrator_;
  Storage storage_;
  PairLayout layout_;
  DeviceQueue queue_;
  std::array<std::optional<OpenclBuffer<float>>, pair_kinds> pairs_;  // [Pair], those that are needed
  std::optional<OpenclBuffer<float>> ghosts_;                         // [Pair][ghost_floats]
  std::vector<OpenclBuffer<std::byte>> arguments_;
  std::array<std::vector<Launch>, 2> launches_;  // [swapped][stage]
  bool swapped_ = false;                         // the state lies in the pair `next`, or only its ghosts do
};

}  // namespace mssim
