#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/devices/buffer.h"
#include "backends/devices/device.h"
#include "backends/devices/device_queue.h"
#include "backends/interface/backend.h"
#include "backends/opencl/pair_layout.h"

namespace mssim {

/// Steps a system by one kernel per stage of the integrator, all steps queued one behind the other: what the
/// `opencl` backend does unless it walks over a cloth (bands.h). A derived class says how nodes lie in
/// memory, gives the program and the arguments that its kernels take, and then calls `prepare`.
class OpenclStages : public Backend {
 public:
  void set_state(const State& state) override;
  void step(int count) override;
  State state() const override;
  std::string device() const override { return queue_.label(); }
  int threads() const override { return queue_.threads(); }
  bool runs_on_host() const override { return queue_.runs_on_host(); }

 protected:
  /// Throws Unsupported unless the device can hold the integrator's pairs and `others`, all bytes.
  OpenclStages(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
               DeviceMemory memory, PairLayout layout, std::vector<std::uint64_t> others);

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

  static constexpr Storage storage = Storage::separate;

  const Integrator& integrator_;
  PairLayout layout_;
  DeviceQueue queue_;
  std::array<std::optional<OpenclBuffer<float>>, pair_kinds> pairs_;  // [Pair], those that are needed
  std::vector<OpenclBuffer<std::byte>> arguments_;
  std::array<std::vector<Launch>, 2> launches_;  // [swapped][stage]
  bool swapped_ = false;                         // the state lies in the pair `next`
};

}  // namespace mssim
