// What users' C++ backends are written with has the same floor. That it takes the same steps as the reference
// is tested with a program: OwnProgram in tests/backends/process.

#include "geometry/vec3.h"
#include "laws/host_laws.h"
#include "src/starters/cpp/mssim_backend.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(CppHeader, LandsAsTheFloorsLawSays) {
  mssim_backend::System system;
  system.floor = {0.25, 0.3, 0.4};
  for (const Vec3d& velocity : {Vec3d{3, -1, 4}, Vec3d{0.1, -5, 0.2}, Vec3d{0, -2, 0}, Vec3d{1, 2, 3}})
    for (const double height : {0.1, 0.25, 0.3}) {
      Vec3d x{1, height, 2}, v = velocity;
      mssim_backend::Vector own_x{x.x, x.y, x.z}, own_v{v.x, v.y, v.z};
      touch_floor(x, v, system.floor.height, system.floor.restitution, system.floor.friction);
      system.land(own_x, own_v);
      EXPECT_EQ(own_x, (mssim_backend::Vector{x.x, x.y, x.z}));
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(own_v[k], (std::array{v.x, v.y, v.z})[k], 1e-15) << height << ' ' << velocity.y;
    }
}

}  // namespace
}  // namespace mssim
