#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "backends/devices/device_queue.h"
#include "backends/devices/device.h"
#include "backends/hybrid/spring_kernel.h"
#include "integrators/integrator.h"

namespace mssim {

/// What of `hybrid` lives on the device: the springs for good; the nodes and the forces in memory that it
/// takes turns with the host to use. Between calls the host has them.
class SpringDevice {
 public:
  /// `lanes`: those that the kernel was written for. `stored`: the pairs that the integrator needs; they and
  /// the forces are zero. Throws Unsupported where all this does not fit into the device's memory, cl::Error.
  SpringDevice(const SpringKernel& spring_kernel, const std::vector<Pair>& stored, const OpenclDevice& device,
               int lanes, DeviceMemory memory);
  ~SpringDevice();
  SpringDevice(const SpringDevice&) = delete;
  SpringDevice& operator=(const SpringDevice&) = delete;

  const DeviceQueue& queue() const { return queue_; }
  /// The nodes of a stored pair.
  std::span<float> pair(Pair stored) const { return host_pairs_[index(stored)]; }
  const float* forces() const { return host_forces_.data(); }

  /// Computes the forces of all springs in a stored pair, and waits for them. Throws cl::Error.
  void compute_forces(Pair stored);

 private:
  void make_launch(const SpringKernel& spring_kernel);

  OpenclChunks chunks_;
  DeviceQueue queue_;
  std::array<std::optional<OpenclBuffer<float>>, pair_kinds> pairs_;  // [Pair], those that are stored
  std::array<std::span<float>, pair_kinds> host_pairs_;               // as mapped
  std::optional<OpenclBuffer<float>> forces_;
  std::span<float> host_forces_;  // as mapped
  std::vector<OpenclBuffer<std::byte>> constants_;
  std::optional<Launch> launch_;  // none without springs
};

}  // namespace mssim
