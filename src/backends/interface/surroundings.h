#pragma once

#include "kernels/surroundings.h"
#include "model/system.h"

namespace mssim {

/// The surroundings of a system, as the backends in single precision compute with them.
inline Surroundings surroundings_of(const System& system) {
  return {static_cast<float>(system.viscous_damping), static_cast<float>(system.gravity),
          static_cast<float>(system.floor.height), static_cast<float>(system.floor.restitution),
          static_cast<float>(system.floor.friction)};
}

}  // namespace mssim
