#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "backends/devices/buffer.h"
#include "backends/devices/device.h"
#include "backends/devices/device_queue.h"
#include "backends/devices/work_items.h"
#include "backends/layouts/node_records.h"
#include "backends/layouts/packed_springs.h"
#include "integrators/integrator.h"
#include "model/system.h"

namespace mssim {

/// What of `hybrid` lives on the device: the springs for good; the nodes and the forces in memory that it
/// takes turns with the host to use. Between calls the host has them.
class SpringDevice {
 public:
  /// Takes `lanes` springs side by side (1, 4, 8 or 16). `stored`: the pairs that the integrator needs; all
  /// are zero. Throws Unsupported where all this does not fit into the device's memory, cl::Error.
  SpringDevice(const System& system, const PackedSprings& packed, const std::vector<Pair>& stored,
               const OpenclDevice& device, int lanes, DeviceMemory memory);
  ~SpringDevice();
  SpringDevice(const SpringDevice&) = delete;
  SpringDevice& operator=(const SpringDevice&) = delete;

  const DeviceQueue& queue() const { return queue_; }
  /// The records of a stored pair, [slots][record_floats].
  std::span<float> pair(Pair stored) const { return host_pairs_[index(stored)]; }
  /// Forces as PackedSprings places them, four floats each, N.
  const float* forces() const { return host_forces_.data(); }

  /// Computes the forces of all springs in a stored pair, and waits for them. Throws cl::Error.
  void compute_forces(Pair stored);

 private:
  void make_launch(const System& system, const PackedSprings& packed, int lanes);

  OpenclChunks chunks_;
  DeviceQueue queue_;
  std::array<std::optional<OpenclBuffer<float>>, pair_kinds> pairs_;  // [Pair], those that are stored
  std::array<std::span<float>, pair_kinds> host_pairs_;               // as mapped
  std::optional<OpenclBuffer<float>> forces_;
  std::span<float> host_forces_;  // as mapped
  std::optional<OpenclBuffer<cl_uint>> units_;
  std::optional<OpenclBuffer<PackedSprings::Entry>> entries_;
  struct Material {
    float stiffness;  // N/m
    float damping;    // N s/m
  };
  std::optional<OpenclBuffer<Material>> materials_;
  std::optional<Launch> launch_;  // none without springs
};

}  // namespace mssim
