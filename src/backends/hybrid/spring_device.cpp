#include "backends/hybrid/spring_device.h"

#include <algorithm>
#include <cstdint>

#include "backends/devices/program.h"

namespace mssim {
namespace {

/// Units that a work-item takes at a time (kernels/packed_springs.cl).
std::size_t units_at_a_time(int lanes) { return lanes == 1 ? 1 : PackedSprings::slice_nodes; }

}  // namespace

SpringDevice::SpringDevice(const System& system, const PackedSprings& packed, const std::vector<Pair>& stored,
                           const OpenclDevice& device, int lanes, DeviceMemory memory)
    : device_(device), memory_(memory), lots_(packed.unit_count() / units_at_a_time(lanes), device, lanes) {
  const std::size_t pair_floats = packed.places() * record_floats;
  const std::size_t force_floats = 4 * (packed.unit_count() + 1);
  std::vector<std::uint64_t> buffers(stored.size(), pair_floats * sizeof(float));
  buffers.insert(buffers.end(),
                 {packed.units.size() * sizeof(cl_uint), packed.entries.size() * sizeof(PackedSprings::Entry),
                  force_floats * sizeof(float)});
  require_memory(device, buffers);

  const cl::Device cl_device(device.id, true);
  context_ = cl::Context(cl_device);
  queue_ = cl::CommandQueue(context_, cl_device);
  for (const Pair pair : stored) {
    auto& buffer = pairs_[index(pair)];
    buffer.emplace(context_, device_, memory_, pair_floats);
    host_pairs_[index(pair)] = buffer->map(queue_, CL_MAP_WRITE);
    std::fill(host_pairs_[index(pair)].begin(), host_pairs_[index(pair)].end(), 0.0F);
  }
  // What lies behind the forces of the units stays zero.
  forces_ = buffer_with(std::span<const float>(std::vector<float>(force_floats)));
  host_forces_ = forces_->map(queue_, CL_MAP_READ);
  if (packed.unit_count() > 0) make_kernel(system, packed, lanes);
}

SpringDevice::~SpringDevice() {
  // A driver keeps a buffer for ever that is mapped when it is released. As if read: nothing is copied back.
  try {
    for (std::size_t i = 0; i < pair_kinds; ++i)
      if (pairs_[i]) pairs_[i]->unmap(queue_, host_pairs_[i], CL_MAP_READ);
    forces_->unmap(queue_, host_forces_, CL_MAP_READ);
    queue_.finish();
  } catch (const cl::Error&) {
    // After a failure, which has been told, some are not mapped; the process's end frees the others.
  }
}

template <class T>
OpenclBuffer<T> SpringDevice::buffer_with(std::span<const T> values) const {
  OpenclBuffer<T> buffer(context_, device_, memory_, values.size());
  buffer.write(queue_, [&](std::span<T> array) { std::copy(values.begin(), values.end(), array.begin()); });
  return buffer;
}

void SpringDevice::make_kernel(const System& system, const PackedSprings& packed, int lanes) {
  std::vector<Material> materials;
  for (const SpringMaterial& material : system.materials)
    materials.push_back({static_cast<float>(material.stiffness), static_cast<float>(material.damping)});
  units_ = buffer_with(std::span(packed.units));
  entries_ = buffer_with(std::span(packed.entries));
  materials_ = buffer_with(std::span<const Material>(materials));
  kernel_.emplace(build_program(context_, cl::Device(device_.id, true), packed_springs_program_text(lanes)),
                  "packed_spring_forces");
  kernel_->setArg(0, units_->buffer());
  kernel_->setArg(2, forces_->buffer());
  kernel_->setArg(3, entries_->buffer());
  kernel_->setArg(4, materials_->buffer());
  kernel_->setArg(5, static_cast<cl_uint>(packed.unit_count()));
  kernel_->setArg(6, static_cast<cl_uint>(lots_.per_item));
}

void SpringDevice::compute_forces(Pair stored) {
  if (!kernel_) return;
  const auto& pair = *pairs_[index(stored)];
  auto& host_pair = host_pairs_[index(stored)];
  forces_->unmap(queue_, host_forces_, CL_MAP_READ);
  pair.unmap(queue_, host_pair, CL_MAP_WRITE);
  kernel_->setArg(1, pair.buffer());
  queue_.enqueueNDRangeKernel(*kernel_, cl::NullRange, cl::NDRange(lots_.global), cl::NDRange(lots_.local));
  host_pair = pair.map(queue_, CL_MAP_WRITE, false);
  host_forces_ = forces_->map(queue_, CL_MAP_READ);
}

}  // namespace mssim
