#pragma once

#include "garment/contact/body_maps.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "mesh/meshing.h"
#include "tests/support/garment_system.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {

/// A body for fits, of which nothing is anywhere but an axis through `axis`, or through the middle of each
/// row.
inline FitBody nobody(std::optional<Vec3d> axis = {}) {
  return {[](std::span<const Vec3d> points) { return std::vector<double>(points.size()); },
          [axis](const Vec3d& middle) {
            return std::vector{axis ? Vec3d{axis->x, middle.y, axis->z} : middle};
          }};
}

/// What dresses a system by the plain list of springs in single precision.
inline std::unique_ptr<DressingBackend> serial_dressing(const System& system, double dt_s = dressing_dt_s) {
  return make_serial_dressing(system, semi_euler, dt_s);
}
/// By threads and the best vectors.
inline std::unique_ptr<DressingBackend> openmp_dressing(const System& system, int threads = 2,
                                                        double dt_s = dressing_dt_s) {
  return make_openmp_dressing(system, semi_euler, dt_s, {.threads = threads});
}
/// In double precision.
inline std::unique_ptr<DressingBackend> reference_dressing(const System& system,
                                                           double dt_s = dressing_dt_s) {
  return make_reference_dressing(system, semi_euler, dt_s);
}
/// The two in single precision.
inline std::array<std::unique_ptr<DressingBackend>, 2> serial_and_openmp(const System& system,
                                                                         double dt_s = dressing_dt_s) {
  return {serial_dressing(system, dt_s), openmp_dressing(system, 2, dt_s)};
}

/// Two squares of 10 x 10 nodes in one plane, 30 mm apart, sewn along the edges that face each other.
inline System two_squares() {
  System system = garment_of({{10, 10, 0.01, {0, 0, 0}}, {10, 10, 0.01, {0.12, 0.004, 0.005}}});
  std::vector<std::uint32_t> right, left;
  const Garment& garment = garment_in(system);
  for (std::uint32_t row = 0; row < 10; ++row) {
    right.push_back(garment.panels[0].node(row, 9));
    left.push_back(garment.panels[1].node(row, 0));
  }
  sew(system, right, left, 0.1);
  system.viscous_damping = 16;
  return system;
}

/// A sheet of several blocks with a heavy hem, hung by two corners, and a second one that is sewn to its
/// side: many springs are too long on the way.
inline System stretched_sheets() {
  System system = garment_of({{53, 21, 0.01, {0, 0, 0}}, {37, 33, 0.01, {0.25, 0.1, 0.01}}});
  const Garment& garment = garment_in(system);
  std::vector<std::uint32_t> right, left;
  for (std::uint32_t row = 0; row < 37; ++row) {
    right.push_back(garment.panels[0].node(row + 8, 20));
    left.push_back(garment.panels[1].node(row, 0));
  }
  sew(system, right, left, 0.36);
  for (std::uint32_t column = 0; column < 21; ++column) system.node_mass[column] *= 20;
  system.pins = {garment.panels[0].node(52, 0), garment.panels[0].node(52, 20)};
  system.materials = {{40, 0}, {12, 0}, {1.6, 0}};
  system.gravity = 9.81;
  system.viscous_damping = 16;
  return system;
}

/// Two panels of several blocks, rolled around a ball, and sewn to each other along both sides: point to
/// point on the left, and on the right each node to a point of an edge.
inline System sack_around_a_ball() {
  constexpr double radius = 0.1, roll = 0.106;
  constexpr std::uint32_t rows = 36, columns = 31;
  System system =
      garment_of({{rows, columns, 0.01, {-0.15, -0.17, 0}}, {rows, columns, 0.01, {-0.15, -0.17, 0}}});
  Garment& garment = garment_in(system);
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    Vec3d& x = system.start.position[i];
    const double angle = x.x / roll, front = i < system.nodes() / 2 ? 1 : -1;
    x = {roll * std::sin(angle), x.y, front * roll * std::cos(angle)};
  }
  round_to_single(system.start);
  std::vector<std::uint32_t> left_front, left_back;
  for (std::uint32_t row = 0; row < rows; ++row) {
    left_front.push_back(garment.panels[0].node(row, 0));
    left_back.push_back(garment.panels[1].node(row, 0));
  }
  sew(system, left_front, left_back, 0.35);
  garment.seams.emplace_back("right");
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    garment.joints.push_back({garment.panels[0].node(row, columns - 1),
                              garment.panels[1].node(row, columns - 1),
                              garment.panels[1].node(row + 1, columns - 1), 0.01 * row, 0.01, 1, 1});
  garment.body_maps.push_back(
      std::make_shared<BodyMaps>(surface_of(SphereShape{radius, 48}), BodyMapSettings{.offset = 0.004}));
  system.gravity = 9.81;
  system.viscous_damping = 16;
  system.floor = {-0.175, 0.3, 0.4};
  return system;
}

/// From a state that it has draped to, a backend goes on as if it had sewn the seams itself; from the same
/// state with open seams it does not: there is no gravity for a step, until it finds them closed.
inline void expect_goes_on_when_draped(DressingBackend& backend, const System& system) {
  backend.set_state(system.start);
  while (!backend.progress().draping) backend.step(50);
  State draped = backend.state();
  backend.step(40);
  const State expected = backend.state();
  draped.draped = false;
  backend.set_state(draped);
  EXPECT_EQ(backend.progress().open_joints, garment_in(system).joints.size());
  backend.step(40);
  EXPECT_GT(largest_distance(backend.state().position, expected.position), 1e-5);
  draped.draped = true;
  backend.set_state(draped);
  EXPECT_EQ(backend.progress().open_joints, 0U);
  EXPECT_TRUE(backend.progress().draping);
  backend.step(40);
  EXPECT_EQ(backend.state().position, expected.position);
  EXPECT_EQ(backend.state().velocity, expected.velocity);
}

}  // namespace mssim
