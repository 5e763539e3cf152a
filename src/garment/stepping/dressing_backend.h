#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

struct OpenclDevice;

/// Progress of a dressing.
struct DressingProgress {
  std::size_t open_joints = 0;  ///< not sewn yet
  bool draping = false;         ///< the seams are closed; gravity and friction act
  std::int64_t seamed_at = 0;   ///< steps after which the seams were closed
};

/// A backend that dresses: its steps are those of Algorithm 1. If it starts from a draped state, all joints
/// are sewn, and gravity and friction act from the first step on; otherwise all joints are open.
class DressingBackend : public Backend {
 public:
  virtual DressingProgress progress() const = 0;
};

/// Whether the integrator can dress garments.
bool dresses(const Integrator& integrator);

/// Algorithm 1 of Vassilev's paper as a straightforward program: one thread, an array of nodes, a list of
/// springs, six loops. `system.topology` is a Garment. Throws Unsupported for an integrator other than
/// semi-euler.
std::unique_ptr<DressingBackend> make_serial_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const ExecutionOptions& options = {});

/// The serial dressing in double precision.
std::unique_ptr<DressingBackend> make_reference_dressing(const System& system, const Integrator& integrator,
                                                         double dt_s);

/// Algorithm 1 in vectors along the rows of the panels, with `threads` and `instruction_set` of the options;
/// bitwise identical for every number of threads. The instruction set is one of openmp_instruction_sets();
/// empty: the best. Throws Unsupported for an integrator other than semi-euler and for springs of one row and
/// direction that differ in stiffness, and Unavailable for another instruction set.
std::unique_ptr<DressingBackend> make_openmp_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const ExecutionOptions& options);

/// The distribution of a garment over a device's work-items.
struct DressingShape {
  int lanes = 1;          ///< adjacent nodes per work-item: 1, 4, 8 or 16
  std::size_t items = 1;  ///< work-items per group, which handles a block of rows; 1 with several lanes

  /// The shape for a device: one work-item with this many lanes, or many work-items if `lanes` is 1.
  static DressingShape of(const OpenclDevice& device, int lanes);
};

/// Algorithm 1 on an OpenCL device (kernels/dressing_step.cl). All steps are queued at once: the host learns
/// at the end of step() whether seams have closed. Throws Unsupported for an integrator other than
/// semi-euler and if the device's memory is too small; Unavailable if its driver fails. It ignores
/// Garment::touching; make_dressing_backend refuses such a garment.
std::unique_ptr<DressingBackend> make_opencl_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const OpenclDevice& device,
                                                      DeviceMemory memory, const DressingShape& shape);

}  // namespace mssim
