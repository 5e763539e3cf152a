#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"

namespace mssim {

struct OpenclDevice;

/// How far the dressing of a garment has come.
struct DressingProgress {
  std::size_t open_joints = 0;  ///< not sewn yet
  bool draping = false;         ///< the seams are closed: gravity and friction act
  std::int64_t seamed_at = 0;   ///< steps after which that was so
};

/// A backend that dresses: its steps are those of Algorithm 1. From a state that is draped on all joints are
/// sewn, and gravity and friction act from the first step on; from any other all joints are open.
class DressingBackend : public Backend {
 public:
  virtual DressingProgress progress() const = 0;
};

/// Whether garments can be dressed with it.
bool dresses(const Integrator& integrator);

/// Algorithm 1 of Vassilev's paper as a straightforward program has it: one thread, an array of nodes, a list
/// of springs, six loops. `system.topology` is a Garment. Throws Unsupported for another integrator than
/// semi-euler.
std::unique_ptr<DressingBackend> make_serial_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s);

/// The serial dressing in double precision.
std::unique_ptr<DressingBackend> make_reference_dressing(const System& system, const Integrator& integrator,
                                                         double dt_s);

/// The instruction sets that the vector code is compiled for and this processor has, the best first.
std::vector<std::string_view> dressing_instruction_sets();

/// Algorithm 1 in vectors along the rows of the panels and on `threads` threads, with the same result to the
/// last bit for any number of them. An empty instruction set is the best. Throws Unsupported for another
/// integrator than semi-euler and for springs of one row and direction that differ in stiffness, and
/// std::invalid_argument for an instruction set that is none of these.
std::unique_ptr<DressingBackend> make_openmp_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, int threads,
                                                      std::string_view instruction_set = "");

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
