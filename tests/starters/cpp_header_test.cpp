// What users' C++ backends are written with has the floor of mssim, and steps as its method says. That its
// steps are those of the reference is tested with a program, OwnProgram in tests/backends/process, which no
// sanitizer sees.

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

TEST(CppHeader, StepsAsItsMethodSaysAndHoldsPins) {
  using mssim_backend::Slot, mssim_backend::Vectors;
  mssim_backend::System system;
  system.dt = 0.5;
  system.position = {{0, 1, 0}, {0, 2, 0}};
  system.velocity = {{1, 0, 0}, {}};
  system.mass = {1, 1};
  system.pins = {1};
  mssim_backend::Method method{"semi-euler", {{Slot::x, Slot::v, {}}}};
  for (const char* line : {"v_next 1 0 v 1 1 a", "x_next 1 0 x 1 1 v_next"}) {
    std::istringstream words(line);
    method.stages[0].assignments.push_back(mssim_backend::detail::assignment_of(words));
  }
  const auto falling = [](const Vectors&, const Vectors&, Vectors& a) { a.assign(2, {0, -1, 0}); };
  const auto backend = mssim_backend::stepped_by(system, method, falling);
  backend->set(system.position, system.velocity);
  backend->step(1);
  Vectors x, v;
  backend->get(x, v);
  EXPECT_EQ(x, (Vectors{{0.5, 0.75, 0}, {0, 2, 0}}));
  EXPECT_EQ(v, (Vectors{{1, -0.5, 0}, {}}));
}

/// The answer of a program whose `prepare` throws this.
template <class Thrown>
std::string answer_to(const Thrown& thrown) {
  return mssim_backend::detail::outcome_of([&]() -> std::string { throw thrown; });
}

TEST(CppHeader, GivesAReasonWhereTheProgramHasNone) {
  EXPECT_EQ(answer_to(mssim_backend::Unsupported("only\nred springs")), "unsupported only red springs");
  EXPECT_EQ(answer_to(mssim_backend::Unsupported("")), "unsupported no reason given");
  EXPECT_EQ(answer_to(mssim_backend::Unavailable(" \n")), "unavailable no reason given");
  EXPECT_EQ(answer_to(std::runtime_error("")), "failed no reason given");
}

}  // namespace
}  // namespace mssim
