#pragma once

#include <cstddef>
#include <memory>

#include "backends/devices/device.h"
#include "garment/stepping/dressing_backend.h"

namespace mssim {

/// How a device's work-items share a garment.
struct DressingShape {
  int lanes = 1;  ///< nodes of a work-item side by side: 1, 4, 8 or 16
  std::size_t items =
      1;  ///< work-items of a group, which takes a block of rows; with several lanes it has one

  /// That suits a device: one work-item with so many lanes, or where that is one, many.
  static DressingShape of(const OpenclDevice& device, int lanes);
};

/// Algorithm 1 on an OpenCL device (kernels/dressing_step.cl), all steps queued one behind the other: the
/// host hears of seams that have closed at the end of step(). Throws Unsupported for another integrator than
/// semi-euler, for layers that touch each other and for what does not fit into the device's memory;
/// Unavailable where its driver fails.
std::unique_ptr<DressingBackend> make_opencl_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const OpenclDevice& device,
                                                      DeviceMemory memory, const DressingShape& shape);

}  // namespace mssim
