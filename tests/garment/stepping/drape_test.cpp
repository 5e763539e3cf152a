// Cloth that comes to rest on a body.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "garment/contact/solid.h"
#include "garment/stepping/dressing_backend.h"
#include "mesh/shapes.h"
#include "model/energy.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/dressing_step.h"
#include "tests/support/garment_system.h"

namespace mssim {
namespace {

constexpr double sphere_radius = 0.15, sheet_dt_s = 2.5e-4;
constexpr std::uint32_t middle = 10;  ///< row and column of the sheet's middle

Surface sphere() { return surface_of(SphereShape{sphere_radius, 24}); }

/// A sheet of 0.4 x 0.4 m, level, 1 cm above the sphere, which it meets as maps this far before its mesh.
System sheet_above_sphere(double offset) {
  System system = garment_of({{21, 21, 0.02, {-0.2, sphere_radius + 0.01, 0.2}, {1, 0, 0}, {0, 0, -1}}});
  system.gravity = 9.81;
  system.viscous_damping = 16;
  put_on(system, sphere(), {.offset = offset});
  return system;
}

DressingResult dropped(const System& system) {
  const auto backend = make_serial_dressing(system, semi_euler, sheet_dt_s);
  return dress(*backend, system, sheet_dt_s, {}, [](const State&, std::int64_t) { return true; });
}

Fit fit_on_sphere(const System& system, const State& state) {
  const Solid solid(sphere());
  return fit_of(system, state.position,
                {[&](std::span<const Vec3d> points) { return solid.depths(points); },
                 [](const Vec3d& point) { return point; }});
}

TEST(Drape, ASheetDroppedOnASphereRestsOnItWithNoPointInside) {
  const System system = sheet_above_sphere(0.003);
  const DressingResult result = dropped(system);
  EXPECT_TRUE(result.settled);
  const Fit fit = fit_on_sphere(system, result.state);
  EXPECT_EQ(fit.nodes_inside, 0U);
  EXPECT_EQ(fit.deepest_face_sample, 0);
  // It lies on the sphere's top, maps and the sagitta of its cells above it, and hangs down around it.
  const GarmentPanel& panel = std::get<Garment>(system.topology).panels[0];
  EXPECT_NEAR(result.state.position[panel.node(middle, middle)].y, sphere_radius + 0.003, 0.003);
  for (const std::uint32_t corner : {panel.node(0, 0), panel.node(0, 20), panel.node(20, 0)})
    EXPECT_LT(result.state.position[corner].y, 0.05);
}

TEST(Drape, MapsInsideTheSphereLetItIn) {
  const System system = sheet_above_sphere(-0.005);
  const Fit fit = fit_on_sphere(system, dropped(system).state);
  EXPECT_GT(fit.nodes_inside, 100U);
  EXPECT_GT(fit.deepest_face_sample, 0.004);
}

/// What all steps in which a state has more energy than the one before add, over what the others take.
struct EnergyBalance {
  double gained = 0, lost = 0;
  double fraction() const { return gained / lost; }
};

/// Of steps after the seams have closed.
EnergyBalance draped(const System& system, double dt_s, int steps) {
  const auto backend = make_serial_dressing(system, semi_euler, dt_s);
  backend->set_state(system.start);
  while (!backend->progress().draping) backend->step(1);
  EnergyBalance balance;
  double before = energy_of(system, backend->state()).total();
  for (int i = 0; i < steps; ++i) {
    backend->step(1);
    const double after = energy_of(system, backend->state()).total();
    (after > before ? balance.gained : balance.lost) += std::abs(after - before);
    before = after;
  }
  return balance;
}

TEST(Drape, StepsInWhichEnergyGrowsAddLittle) {
  const EnergyBalance sheet = draped(sheet_above_sphere(0.003), sheet_dt_s, 4000);
  EXPECT_LT(sheet.fraction(), 0.05);
  RecordProperty("sheet", std::to_string(sheet.fraction()));
  // Jeans come to rest 1,617 steps after their seams have closed.
  const DressingCase jeans("jeans4k");
  const EnergyBalance balance = draped(jeans.system, jeans.dt_s(), 1617);
  EXPECT_LT(balance.fraction(), 0.05) << balance.gained << " J of " << balance.lost;
  RecordProperty("jeans", std::to_string(balance.fraction()));
}

TEST(Drape, OnABodyGivesTheSameBitsForAnyNumberOfThreads) {
  const DressingCase jeans("jeans1k");
  const auto run = [&](int threads) {
    const auto backend = make_openmp_dressing(jeans.system, semi_euler, jeans.dt_s(), threads);
    backend->step(800);
    EXPECT_TRUE(backend->progress().draping);
    return backend->state();
  };
  const State one = run(1);
  for (const int threads : {2, 3, 7}) {
    const State several = run(threads);
    EXPECT_EQ(several.position, one.position) << threads;
    EXPECT_EQ(several.velocity, one.velocity) << threads;
  }
}

}  // namespace
}  // namespace mssim
