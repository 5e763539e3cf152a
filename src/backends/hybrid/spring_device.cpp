#include "backends/hybrid/spring_device.h"

#include <cstdint>

#include "backends/devices/program.h"

namespace mssim {
namespace {

/// Units that a work-item takes at a time (kernels/packed_springs.cl).
std::size_t units_at_a_time(int lanes) { return lanes == 1 ? 1 : PackedSprings::slice_nodes; }

}  // namespace

SpringDevice::SpringDevice(const System& system, const PackedSprings& packed, const std::vector<Pair>& stored,
                           const OpenclDevice& device, int lanes, DeviceMemory memory)
    : chunks_(packed.unit_count() / units_at_a_time(lanes), device, lanes), queue_(device, memory) {
  const std::size_t pair_floats = packed.slots() * record_floats;
  const std::size_t force_floats = 4 * (packed.unit_count() + 1);
  std::vector<std::uint64_t> buffers(stored.size(), pair_floats * sizeof(float));
  buffers.insert(buffers.end(),
                 {packed.units.size() * sizeof(cl_uint), packed.entries.size() * sizeof(PackedSprings::Entry),
                  force_floats * sizeof(float)});
  require_memory(device, buffers);

  for (const Pair pair : stored) {
    auto& buffer = pairs_[index(pair)];
    buffer = queue_.zeros<float>(pair_floats);
    host_pairs_[index(pair)] = buffer->map(queue_.commands(), CL_MAP_WRITE);
  }
  // What lies behind the forces of the units stays zero.
  forces_ = queue_.zeros<float>(force_floats);
  host_forces_ = forces_->map(queue_.commands(), CL_MAP_READ);
  if (packed.unit_count() > 0) make_launch(system, packed, lanes);
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

void SpringDevice::make_launch(const System& system, const PackedSprings& packed, int lanes) {
  std::vector<Material> materials;
  for (const SpringMaterial& material : system.materials)
    materials.push_back({static_cast<float>(material.stiffness), static_cast<float>(material.damping)});
  units_ = queue_.copy_of(std::span<const cl_uint>(packed.units));
  entries_ = queue_.copy_of(std::span<const PackedSprings::Entry>(packed.entries));
  materials_ = queue_.copy_of(std::span<const Material>(materials));
  cl::Kernel kernel(queue_.build(packed_springs_program_text(lanes)), "packed_spring_forces");
  kernel.setArg(0, units_->buffer());
  kernel.setArg(2, forces_->buffer());
  kernel.setArg(3, entries_->buffer());
  kernel.setArg(4, materials_->buffer());
  kernel.setArg(5, static_cast<cl_uint>(packed.unit_count()));
  kernel.setArg(6, static_cast<cl_uint>(chunks_.per_item));
  launch_ = {kernel, chunks_.items};
}

void SpringDevice::compute_forces(Pair stored) {
  if (!launch_) return;
  const auto& pair = *pairs_[index(stored)];
  auto& host_pair = host_pairs_[index(stored)];
  forces_->unmap(queue_.commands(), host_forces_, CL_MAP_READ);
  pair.unmap(queue_.commands(), host_pair, CL_MAP_WRITE);
  launch_->kernel.setArg(1, pair.buffer());
  queue_.launch(*launch_);
  host_pair = pair.map(queue_.commands(), CL_MAP_WRITE, false);
  host_forces_ = forces_->map(queue_.commands(), CL_MAP_READ);
}

}  // namespace mssim
