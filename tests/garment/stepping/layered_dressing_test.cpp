// Garments of several layers in a step of Algorithm 1.

#include "garment/contact/body_maps.h"
#include "garment/layers/cloth_contacts.h"
#include "garment/stepping/dressing_backend.h"
#include "garment/stepping/dressing_rules.h"
#include "mesh/meshing.h"
#include "tests/support/backend_checks.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(LayeredDressing, PanelsMeetTheBodyAsTheirLayerDoes) {
  // Patches of layers 0, 1 and 2 begin half a millimetre inside a sphere's surface, before its front.
  const double radius = 0.2;
  const Surface sphere = surface_of(SphereShape{radius, 48});
  System system =
      garment_of({{4, 4, 0.01, {-0.055, 0, 0}}, {4, 4, 0.01, {-0.015, 0, 0}}, {4, 4, 0.01, {0.025, 0, 0}}});
  for (Vec3d& point : system.start.position)
    point.z = std::sqrt(std::pow(radius - 0.0005, 2) - point.x * point.x - point.y * point.y);
  // Springs of this curvature would move the nodes.
  for (SpringMaterial& material : system.materials) material.stiffness = 0;
  round_to_single(system.start);
  Garment& garment = garment_in(system);
  for (std::uint32_t layer = 0; layer < 3; ++layer) garment.panels[layer].layer = layer;
  for (const double offset : {0.002, 0.005})
    garment.body_maps.push_back(
        std::make_shared<BodyMaps>(sphere, BodyMapSettings{.pixel = 0.001, .offset = offset}));

  const std::vector<double> wanted{0.002, 0.005, 0.005};  // the third layer has no maps of its own
  for (const auto& backend : serial_and_openmp(system)) {
    backend->step(100);  // at 1 m/s far enough for 15 mm
    const std::vector<Vec3d> position = backend->state().position;
    for (const GarmentPanel& panel : garment.panels)
      for (std::uint32_t node = panel.first_node; node < panel.first_node + panel.nodes(); ++node)
        EXPECT_NEAR(length(position[node]) - radius, wanted[panel.layer], 5e-4) << "node " << node;
  }
}

TEST(LayeredDressing, LeavesTheLastWordToTheBody) {
  // A heavier outer patch falls at 3 m/s on one that lies before a sphere: 0.45 mm in a step, three times as
  // far as the body pushes out.
  const double radius = 0.2;
  System system = garment_of({{4, 4, 0.01, {-0.015, -0.015, 0}}, {4, 4, 0.01, {-0.014, -0.013, 0}}});
  for (std::size_t node = 0; node < system.nodes(); ++node) {
    const bool outer = node >= 16;
    Vec3d& at = system.start.position[node];
    at.z = std::sqrt(std::pow(radius + (outer ? 0.006 : 0.0025), 2) - at.x * at.x - at.y * at.y);
    if (!outer) continue;
    system.start.velocity[node] = {0, 0, -3};
    system.node_mass[node] *= 3;
  }
  for (SpringMaterial& material : system.materials) material.stiffness = 0;
  round_to_single(system.start);
  Garment& garment = garment_in(system);
  garment.panels[1].layer = 1;
  garment.touching = ClothClothSettings{.thickness = 0.003};
  garment.body_maps = {std::make_shared<BodyMaps>(surface_of(SphereShape{radius, 48}),
                                                  BodyMapSettings{.pixel = 0.001, .offset = 0.002})};
  for (const auto& backend : serial_and_openmp(system)) {
    double deepest = HUGE_VAL, nearest = HUGE_VAL;
    for (int step = 0; step < 60; ++step) {
      backend->step(1);
      const std::vector<Vec3d> position = backend->state().position;
      for (std::size_t node = 0; node < 16; ++node) {
        deepest = std::min(deepest, length(position[node]) - radius);
        nearest = std::min(nearest, length(position[node + 16]) - length(position[node]));
      }
    }
    EXPECT_GT(deepest, 0.0019);
    EXPECT_LT(nearest, 0.0031) << "they do not meet";
  }
}

/// An outer sheet of `side` x `side` nodes that flies at 2 to 3 m/s, 5 mm away, onto an inner one of which
/// one row is held.
System flying_sheet(std::uint32_t side) {
  const double width = 0.01 * (side - 1);
  System system = garment_of({{side, side, 0.01, {0, 0, 0}}, {side, side, 0.01, {0.003, 0.004, 0.005}}});
  for (std::uint32_t column = 0; column < side; ++column) system.pins.push_back(column);
  for (std::size_t node = std::size_t{side} * side; node < system.nodes(); ++node) {
    const Vec3d& at = system.start.position[node];
    system.start.velocity[node] = {0, 0, -2 - at.x * at.y / (width * width)};  // not level: folds
  }
  Garment& garment = garment_in(system);
  garment.panels[1].layer = 1;
  garment.touching = ClothClothSettings{.thickness = 0.003, .friction = 0.3};
  round_to_single(system.start);
  return system;
}

std::size_t crossings_after(const System& system, DressingBackend& backend, int steps) {
  const Garment& garment = garment_in(system);
  backend.step(steps);
  return count_crossings(garment, backend.state().position);
}

TEST(LayeredDressing, KeepsLayersApartThatWouldCross) {
  System system = flying_sheet(12);
  for (const auto& backend : {serial_dressing(system), openmp_dressing(system), reference_dressing(system)}) {
    EXPECT_EQ(crossings_after(system, *backend, 14), 0U);
    EXPECT_EQ(crossings_after(system, *backend, 386), 0U);  // 60 ms in all; they meet after 1 ms
  }
  // The inner one has taken some of the other's momentum.
  const auto backend = serial_dressing(system);
  EXPECT_LT(state_after(*backend, 100).position[12 * 6 + 6].z, -0.005);
  EXPECT_EQ(backend->state().position[3], system.start.position[3]) << "pins stay";

  garment_in(system).touching.reset();
  // 2.1 ms, when the fast part is through and the slow one is not
  EXPECT_GT(crossings_after(system, *serial_dressing(system), 14), 0U);
  EXPECT_GT(crossings_after(system, *openmp_dressing(system), 14), 0U);
}

TEST(LayeredDressing, AgreesAmongBackendsWhileLayersTouch) {
  const System system = flying_sheet(12);
  const auto serial = serial_dressing(system);
  const auto openmp = openmp_dressing(system);
  const auto reference = reference_dressing(system);
  for (DressingBackend* backend : {serial.get(), openmp.get(), reference.get()}) backend->step(40);
  const std::vector<Vec3d> wanted = reference->state().position;
  // Roundings of 40 steps; two layers that touch or do not differ by 2 mm and more.
  EXPECT_LT(largest_distance(serial->state().position, wanted), 1e-5);
  EXPECT_LT(largest_distance(openmp->state().position, wanted), 1e-5);
}

TEST(LayeredDressing, IsTheSameToTheLastBitForAnyNumberOfThreads) {
  // Searched by one thread and by many.
  for (const std::uint32_t side : {20U, 91U}) {
    const System system = flying_sheet(side);
    ASSERT_EQ(system.nodes() < least_shared_nodes, side == 20);
    const State wanted = state_after(*openmp_dressing(system, 1), 30);
    for (const int threads : {2, 3}) {
      const auto many = openmp_dressing(system, threads);
      many->step(12);  // no matter how steps are cut
      EXPECT_TRUE(same_state(state_after(*many, 18), wanted)) << side << ", " << threads;
    }
  }
}

}  // namespace
}  // namespace mssim
