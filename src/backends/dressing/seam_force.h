#pragma once

#include <cstddef>
#include <cstdint>

#include "model/garment.h"

namespace mssim {

/// How far the dressing of a garment has come.
struct DressingProgress {
  std::size_t open_joints = 0;  ///< not sewn yet
  bool draping = false;         ///< the seams are closed: gravity and friction act
  std::int64_t seamed_at = 0;   ///< steps after which that was so
};

/// Force that draws a joint together, N: of constant size while its gap closes, growing with time.
inline double seam_force(const Dressing& dressing, const Joint& joint, double time_s) {
  return dressing.seam_force * (1 + time_s / dressing.seam_force_doubling_s) * joint.length * joint.strength;
}

}  // namespace mssim
