#pragma once

#include "model/garment.h"

namespace mssim {

/// Force that draws a joint together, N: of constant size while its gap closes, growing with time.
inline double seam_force(const Dressing& dressing, const Joint& joint, double time_s) {
  return dressing.seam_force * (1 + time_s / dressing.seam_force_doubling_s) * joint.length * joint.strength;
}

}  // namespace mssim
