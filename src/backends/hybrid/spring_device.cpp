#include "backends/hybrid/spring_device.h"

#include <cstdint>

namespace mssim {

SpringDevice::SpringDevice(const SpringKernel& spring_kernel, const std::vector<Pair>& stored,
                           const OpenclDevice& device, int lanes, DeviceMemory memory)
    : chunks_(spring_kernel.parts, device, lanes), queue_(device, memory) {
  std::vector<std::uint64_t> buffers(stored.size(), spring_kernel.pair_floats * sizeof(float));
  for (const std::span<const std::byte> constants : spring_kernel.constants)
    buffers.push_back(constants.size());
  buffers.push_back(spring_kernel.force_floats * sizeof(float));
  require_memory(device, buffers);

  for (const Pair pair : stored) {
    auto& buffer = pairs_[index(pair)];
    buffer = queue_.zeros<float>(spring_kernel.pair_floats);
    host_pairs_[index(pair)] = buffer->map(queue_.commands(), CL_MAP_WRITE);
  }
  forces_ = queue_.zeros<float>(spring_kernel.force_floats);
  host_forces_ = forces_->map(queue_.commands(), CL_MAP_READ);
  if (spring_kernel.parts > 0) make_launch(spring_kernel);
}

SpringDevice::~SpringDevice() {
  // A driver keeps a buffer for ever that is mapped when it is released. As if read: nothing is copied back.
  try {
    for (std::size_t i = 0; i < pair_kinds; ++i)
      if (pairs_[i]) pairs_[i]->unmap(queue_.commands(), host_pairs_[i], CL_MAP_READ);
    forces_->unmap(queue_.commands(), host_forces_, CL_MAP_READ);
    queue_.commands().finish();
  } catch (const cl::Error&) {
    // After a failure, which has been told, some are not mapped; the process's end frees the others.
  }
}

void SpringDevice::make_launch(const SpringKernel& spring_kernel) {
  cl::Kernel kernel(queue_.build(spring_kernel.text), spring_kernel.name);
  kernel.setArg(1, forces_->buffer());
  cl_uint argument = 2;
  for (const std::span<const std::byte> constants : spring_kernel.constants) {
    constants_.push_back(queue_.copy_of(constants));
    kernel.setArg(argument++, constants_.back().buffer());
  }
  kernel.setArg(argument++, static_cast<cl_uint>(spring_kernel.parts));
  kernel.setArg(argument, static_cast<cl_uint>(chunks_.per_item));
  launch_ = {kernel, chunks_.items};
}

void SpringDevice::compute_forces(Pair stored) {
  if (!launch_) return;
  const auto& pair = *pairs_[index(stored)];
  auto& host_pair = host_pairs_[index(stored)];
  forces_->unmap(queue_.commands(), host_forces_, CL_MAP_READ);
  pair.unmap(queue_.commands(), host_pair, CL_MAP_WRITE);
  launch_->kernel.setArg(0, pair.buffer());
  queue_.launch(*launch_);
  host_pair = pair.map(queue_.commands(), CL_MAP_WRITE, false);
  host_forces_ = forces_->map(queue_.commands(), CL_MAP_READ);
}

}  // namespace mssim
