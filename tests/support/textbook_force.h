#pragma once

#include "model/system.h"

namespace mssim {

/// The force of a spring on its first end as textbooks have it, N: an independent form of
/// kernels/spring_law.h. d: from there to the second end, m; u: the second end's velocity less the first
/// one's, m/s.
inline Vec3d textbook_force(const SpringMaterial& spring, double rest_length, const Vec3d& d,
                            const Vec3d& u) {
  const Vec3d n = 1 / length(d) * d;
  return (spring.stiffness * (length(d) - rest_length) + spring.damping * dot(u, n)) * n;
}

}  // namespace mssim
