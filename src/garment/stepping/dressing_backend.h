#pragma once

#include <cstddef>
#include <cstdint>

#include "backends/interface/backend.h"

namespace mssim {

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

/// Throws Unsupported for another integrator than semi-euler.
void require_semi_euler(const Integrator& integrator);

}  // namespace mssim
