// What users' C++ backends are written with takes the same steps as the reference, and the same floor.

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "laws/host_laws.h"
#include "src/starters/cpp/mssim_backend.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "tests/support/textbook_force.h"

namespace mssim {
namespace {

mssim_backend::Vectors vectors_of(const std::vector<Vec3d>& nodes) {
  mssim_backend::Vectors vectors;
  for (const Vec3d& node : nodes) vectors.push_back({node.x, node.y, node.z});
  return vectors;
}

std::vector<Vec3d> nodes_of(const mssim_backend::Vectors& vectors) {
  std::vector<Vec3d> nodes;
  for (const mssim_backend::Vector& vector : vectors) nodes.push_back({vector[0], vector[1], vector[2]});
  return nodes;
}

mssim_backend::System system_of(const System& system, double dt_s) {
  mssim_backend::System result;
  result.dt = dt_s;
  result.position = vectors_of(system.start.position);
  result.velocity = vectors_of(system.start.velocity);
  result.mass = system.node_mass;
  result.pins = system.pins;
  for (const Spring& spring : system.springs) {
    result.springs.push_back({spring.first, spring.second});
    result.rest_length.push_back(spring.rest_length);
    result.stiffness.push_back(system.materials[spring.kind].stiffness);
    result.damping.push_back(system.materials[spring.kind].damping);
  }
  result.gravity = {0, -system.gravity, 0};
  result.viscous_damping = system.viscous_damping;
  result.floor = {system.floor.height, system.floor.restitution, system.floor.friction};
  return result;
}

mssim_backend::Slot slot_of(Slot slot) { return static_cast<mssim_backend::Slot>(slot); }

mssim_backend::Method method_of(const Integrator& integrator) {
  mssim_backend::Method method{std::string(integrator.name), {}};
  for (std::size_t s = 0; s < integrator.stage_count; ++s) {
    const Stage& stage = integrator.stages[s];
    auto& copy = method.stages.emplace_back(
        mssim_backend::Stage{slot_of(position_slot(stage.gather)), slot_of(velocity_slot(stage.gather)), {}});
    for (std::size_t l = 0; l < assignment_count(stage); ++l) {
      const Assignment& assignment = stage.assignments[l];
      auto& line = copy.assignments.emplace_back(mssim_backend::Assignment{slot_of(assignment.out), {}});
      for (std::size_t t = 0; t < term_count(assignment); ++t)
        line.terms.push_back({assignment.terms[t].coefficient, assignment.terms[t].dt_power,
                              slot_of(assignment.terms[t].slot)});
    }
  }
  return method;
}

/// Steps both from the start, and expects the same but for roundings.
void expect_same_steps(const System& system, int steps) {
  mssim_backend::System copy = system_of(system, backend_dt_s);
  const auto acceleration = [&copy](const auto& x, const auto& v, auto& a) {
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) a[i][k] = copy.gravity[k] - copy.viscous_damping * v[i][k];
    for (std::size_t s = 0; s < copy.springs.size(); ++s) {
      const auto [first, second] = copy.springs[s];
      const Vec3d d =
          Vec3d{x[second][0], x[second][1], x[second][2]} - Vec3d{x[first][0], x[first][1], x[first][2]};
      const Vec3d u =
          Vec3d{v[second][0], v[second][1], v[second][2]} - Vec3d{v[first][0], v[first][1], v[first][2]};
      const Vec3d force = textbook_force({copy.stiffness[s], copy.damping[s]}, copy.rest_length[s], d, u);
      const std::array<double, 3> f{force.x, force.y, force.z};
      for (std::size_t k = 0; k < 3; ++k) {
        a[first][k] += f[k] / copy.mass[first];
        a[second][k] -= f[k] / copy.mass[second];
      }
    }
  };
  for (const Integrator& integrator : integrators) {
    SCOPED_TRACE(integrator.name);
    copy.dt = backend_dt_of(integrator);
    const std::unique_ptr<Backend> reference = make_reference(system, integrator, copy.dt);
    reference->step(steps);
    const mssim_backend::Method method = method_of(integrator);
    const auto backend = mssim_backend::stepped_by(copy, method, acceleration);
    backend->set(copy.position, copy.velocity);
    backend->step(steps);
    mssim_backend::Vectors x, v;
    backend->get(x, v);
    EXPECT_LT(largest_distance(nodes_of(x), reference->state().position), 1e-11);
    EXPECT_LT(largest_distance(nodes_of(v), reference->state().velocity), 1e-8);
  }
}

TEST(CppHeader, StepsAPinnedClothAsTheReferenceDoes) { expect_same_steps(cloth_system(12, 9), 200); }

TEST(CppHeader, StepsABodyThroughTheFloorAsTheReferenceDoes) {
  const System block = solid_block(4, 4, 4, 0.001);
  const int steps = 200;
  const std::unique_ptr<Backend> reference = make_reference(block, integrators[0], backend_dt_s);
  reference->step(steps);
  bool stands = false;
  for (const Vec3d& x : reference->state().position) stands |= x.y == block.floor.height;
  ASSERT_TRUE(stands);  // or the floor is not tested
  expect_same_steps(block, steps);
}

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
