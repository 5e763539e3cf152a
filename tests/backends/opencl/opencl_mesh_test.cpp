// Tetrahedral bodies on the OpenCL backends, in every width, against the double-precision reference. That no
// way to share the work or memory changes a bit is tested in opencl_test.cpp, for cloths and bodies.

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/opencl_variants.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class EachWidthAndIntegrator : public testing::TestWithParam<std::tuple<bool, int, Integrator>> {
 protected:
  const Integrator& integrator() const { return *find_integrator(std::get<2>(GetParam()).name); }
  std::unique_ptr<Backend> make(const System& system) const {
    return OpenclVariant{std::get<0>(GetParam()), std::get<1>(GetParam())}.make(system, integrator(),
                                                                                backend_dt_of(integrator()));
  }
};

INSTANTIATE_TEST_SUITE_P(Tables, EachWidthAndIntegrator,
                         testing::Combine(testing::Bool(), testing::ValuesIn(opencl_lanes),
                                          testing::ValuesIn(integrators)),
                         [](const auto& test) {
                           return ByName::of(std::get<0>(test.param) ? "hybrid" : "opencl",
                                             std::to_string(std::get<1>(test.param)) + "_lanes_" +
                                                 std::string(std::get<2>(test.param).name));
                         });

TEST_P(EachWidthAndIntegrator, AgreesWithTheReferenceOnBodiesOfAnySize) {
  // One tetrahedral cube, fewer nodes than lanes, sizes that no number of lanes divides, a node without
  // springs, two bodies in one, more and fewer alike ones than lanes.
  for (const System& system : {solid_block(2, 2, 2), solid_block(2, 3, 2), solid_block(3, 4, 5),
                               solid_block(7, 5, 6), block_and_lone_node(), two_solid_blocks(),
                               alike_bodies(solid_block(3, 4, 3), 19), alike_bodies(solid_block(3, 4, 3), 9)})
    EXPECT_TRUE(agrees(*make(system), system, integrator(), backend_dt_of(integrator())));
}

TEST_P(EachWidthAndIntegrator, HoldsPinsExactlyAndMovesTheirNeighboursLikeTheReference) {
  const System block = pinned(solid_block(5, 4, 6), {0, 1, 17, 50, 119});  // the first and the last, too
  for (const System& system : {block, alike_bodies(block, 9)}) {
    const auto simulation = make(system);
    EXPECT_TRUE(agrees(*simulation, system, integrator(), backend_dt_of(integrator())));
    EXPECT_TRUE(pins_hold(system, simulation->state()));
  }
}

TEST_P(EachWidthAndIntegrator, BouncesOffTheFloorLikeTheReference) {
  // Flat on the floor and slow enough that, in any precision, the same nodes land in the same step.
  System system = solid_block(4, 3, 5, 0);
  for (Vec3d& x : system.start.position) x.y = std::max(x.y, 0.0) + (x.y < 0.012 ? -1e-3 : 0);
  for (Vec3d& v : system.start.velocity) v = {0.5, -1, 0.25};
  round_to_single(system.start);
  const auto reference = make_reference(system, integrator(), backend_dt_of(integrator()));
  const auto simulation = make(system);
  reference->step(1);
  simulation->step(1);
  const State expected = reference->state(), state = simulation->state();
  int landed = 0;
  for (std::size_t node = 0; node < system.nodes(); ++node) {
    if (expected.position[node].y == 0) {
      ++landed;
      EXPECT_EQ(state.position[node].y, 0);
      EXPECT_GT(state.velocity[node].y, 0);
    }
    EXPECT_NEAR(state.velocity[node].x, expected.velocity[node].x, 1e-4) << node;
    EXPECT_NEAR(state.velocity[node].y, expected.velocity[node].y, 1e-4) << node;
    EXPECT_NEAR(state.velocity[node].z, expected.velocity[node].z, 1e-4) << node;
    EXPECT_NEAR(state.position[node].y, expected.position[node].y, 1e-7) << node;
  }
  EXPECT_GT(landed, 4);
}

TEST_P(EachWidthAndIntegrator, StartsAgainFromAStateThatItIsGiven) {
  const System system = two_solid_blocks();
  expect_starts_again(*make(system), system);
}

TEST_P(EachWidthAndIntegrator, StepsNodesThatHaveNoSpringsAtAll) {
  System system = solid_block(2, 2, 2);
  system.springs.clear();
  system.topology = TetrahedralMesh{};
  system.viscous_damping = 0;
  const State state = state_after(*make(system), 10);
  for (std::size_t node = 0; node < system.nodes(); ++node)
    EXPECT_NEAR(state.velocity[node].y,
                system.start.velocity[node].y - 9.81 * backend_dt_of(integrator()) * 10, 1e-6);
}

TEST(OpenclMeshes, TakeSpringsOfSeveralMaterialsInOneNodeInHybrid) {
  System system = solid_block(7, 5, 6);
  system.materials.push_back({50, 0.2});
  for (std::size_t i = 0; i < system.springs.size(); i += 3) system.springs[i].kind = 1;
  for (const Integrator& integrator : integrators)
    for (const int lanes : {1, most_opencl_lanes}) {
      const double dt_s = backend_dt_of(integrator);
      const auto hybrid = OpenclVariant{true, lanes}.make(system, integrator, dt_s);
      EXPECT_TRUE(agrees(*hybrid, system, integrator, dt_s)) << integrator.name;
    }
}

TEST(OpenclMeshes, GiveABodyTheSameBitsAloneAndBesideOthersThatAreAlike) {
  const System block = solid_block(3, 4, 3), system = alike_bodies(block, 19);
  const OpenclDevice device = first_opencl_device();
  for (const Integrator& integrator : integrators)
    for (const int lanes : opencl_lanes) {
      const double dt_s = backend_dt_of(integrator);
      const auto beside = make_opencl(system, integrator, dt_s, device, lanes);
      const auto alone = make_opencl(block, integrator, dt_s, device, lanes);  // from its sliced graph
      beside->step(50);
      alone->step(50);
      State first = beside->state();
      first.position.resize(block.nodes());
      first.velocity.resize(block.nodes());
      EXPECT_TRUE(same_state(first, alone->state())) << integrator.name << ", " << lanes;
      EXPECT_EQ(beside->stored_springs(), block.springs.size());
      EXPECT_EQ(alone->stored_springs(), std::nullopt);
    }
}

TEST(OpenclMeshes, SayWhyTheyDoNotFit) {
  const System system = solid_block(7, 5, 6);
  OpenclDevice device = first_opencl_device();
  device.max_allocation_bytes = 1000;
  const auto says_why = AllOf(HasSubstr("needs an OpenCL buffer of"), HasSubstr(device.name));
  EXPECT_THAT(
      sentence_of<Unsupported>([&] { make_opencl(system, integrators.front(), backend_dt_s, device, 4); }),
      says_why);
  EXPECT_THAT(
      sentence_of<Unsupported>([&] { make_hybrid(system, integrators.front(), backend_dt_s, device, 1, 4); }),
      says_why);
}

}  // namespace
}  // namespace mssim
