// What one step of Algorithm 1 does, on systems whose answer is known.
#include <omp.h>

#include "backends/backends.h"
#include "backends/openmp/openmp.h"
#include "garment/contact/solid.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "garment/stepping/garment_grid.h"
#include "mesh/meshing.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(Dresses, SaysWhichBackendsTakeAGarment) {
  const System system = two_squares();
  for (const BackendInfo& backend : mssim::backends()) {
    bool refused = false;
    try {
      make_backend(backend, system, semi_euler, dressing_dt_s, {.threads = 1});
    } catch (const Unsupported&) {
      refused = true;
    } catch (const Unavailable&) {
      continue;  // without a device nobody knows
    }
    EXPECT_EQ(dresses(backend), !refused) << backend.name;
  }
}

TEST(Dressing, ClosesTheSeamOfTwoSquaresInFreeSpace) {
  const System system = two_squares();
  const auto backend = serial_dressing(system);
  EXPECT_EQ(backend->progress().open_joints, 10U);
  const DressingResult result = dress(*backend, system, dressing_dt_s, {}, always);
  ASSERT_TRUE(result.seamed_at);
  EXPECT_TRUE(result.settled);
  EXPECT_EQ(backend->progress().open_joints, 0U);
  const Fit fit = fit_of(system, result.state.position, nobody());
  EXPECT_LT(fit.largest_gap, 1e-4);
  EXPECT_LT(fit.elongation_max, 0.01);
  // The squares pull each other: what is not damped away moves nobody's centre.
  Vec3d before, after;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    before += system.start.position[i];
    after += result.state.position[i];
  }
  EXPECT_LT(length(after - before) / static_cast<double>(system.nodes()), 1e-5);
}

TEST(Dressing, PullsAJointWithItsShareOfTheSeamsForceAndNotWithGravity) {
  System system = two_squares();
  system.gravity = 9.81;
  const State state = state_after(*reference_dressing(system), 1);
  const Garment& garment = garment_in(system);
  // At rest, nothing but the joints pulls: v = dt F / m, F = 4 N/m * 0.01 m of seam.
  const double mass = 0.4 * 1e-4;
  for (const Joint& joint : garment.joints) {
    const Vec3d gap = system.start.position[joint.edge_first] - system.start.position[joint.node];
    const Vec3d expected = dressing_dt_s * 0.04 / mass / length(gap) * gap;
    // The start is rounded to single precision, which strains the springs by 1e-7.
    EXPECT_LT(length(state.velocity[joint.node] - expected), 1e-3 * length(expected));
    EXPECT_LT(length(state.velocity[joint.edge_first] + expected), 1e-3 * length(expected));
  }
  EXPECT_LT(length(state.velocity[garment.panels[0].node(3, 3)]), 1e-4);
}

TEST(Dressing, LetsPanelsFallWhileTheirSeamsCloseOnlyWhereAskedTo) {
  System system = two_squares();
  system.gravity = 9.81;
  system.floor.height = -0.02;
  garment_in(system).dressing.seam_force = 0;
  garment_in(system).dressing.seaming_damping = 0;
  for (const double fraction : {0.0, 0.5}) {
    garment_in(system).dressing.seaming_gravity = fraction;
    for (const auto& backend : serial_and_openmp(system)) {
      backend->step(100);
      // Semi-implicit Euler falls dt^2 g n (n + 1) / 2.
      EXPECT_NEAR(backend->state().position[0].y,
                  -fraction * 9.81 * dressing_dt_s * dressing_dt_s * 100 * 101 / 2, 1e-6);
      const State state = state_after(*backend, 1000);
      const auto lowest = std::ranges::min(state.position, {}, &Vec3d::y).y;
      // Free, a half of gravity would take them 67 mm down by now.
      EXPECT_GE(lowest, fraction > 0 ? -0.02 : -1e-5);
      EXPECT_LT(lowest, fraction > 0 ? -1e-3 : 1e-5);
    }
  }
}

TEST(Dressing, HoldsTheUpperEdgesAtTheirHeightUntilTheSeamsAreClosed) {
  System system = two_squares();
  system.gravity = 9.81;
  DressingSettings& rules = garment_in(system).dressing;
  rules.seaming_gravity = 1;
  rules.edge_held = true;
  rules.longest_seaming_s = 200.5 * dressing_dt_s;
  rules.seam_force = 0.1;
  for (const auto& backend : serial_and_openmp(system)) {
    backend->step(200);
    ASSERT_FALSE(backend->progress().draping);
    const std::vector<Vec3d> seaming = backend->state().position;
    for (const GarmentPanel& panel : garment_in(system).panels)
      for (std::uint32_t column = 0; column < panel.columns; ++column) {
        const std::uint32_t upper = panel.node(9, column), lower = panel.node(0, column);
        EXPECT_EQ(seaming[upper].y, system.start.position[upper].y) << panel.name << ", " << column;
        // The cloth hangs from it, longer by rho g h^2 / 2 k = 0.1 mm, and swings; free, it would have fallen
        // by 40 times as much.
        EXPECT_NEAR(seaming[lower].y, system.start.position[lower].y, 4e-4);
      }
    // Along the edge they are free: the seam draws them together.
    const GarmentPanel& left = garment_in(system).panels[0];
    EXPECT_GT(seaming[left.node(9, 9)].x, system.start.position[left.node(9, 9)].x + 1e-4);
    backend->step(101);
    ASSERT_TRUE(backend->progress().draping);
    // Let go, an edge falls dt^2 g n (n + 1) / 2 in n steps of draping, less what its damping of 16/s takes.
    const double fall = 9.81 * dressing_dt_s * dressing_dt_s * 100 * 101 / 2;
    EXPECT_LT(backend->state().position[left.node(9, 0)].y, seaming[left.node(9, 0)].y - 0.5 * fall);
  }
}

TEST(Dressing, SewsAJointToAPointOfAnEdge) {
  // A strip of two rows against one edge of a coarser strip.
  System system = garment_of({{2, 3, 0.01, {0, 0.02, 0}}, {2, 2, 0.02, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}}});
  Garment& garment = garment_in(system);
  garment.seams = {"strip"};
  for (std::uint32_t column = 0; column < 3; ++column)
    garment.joints.push_back(
        {column, garment.panels[1].node(0, 0), garment.panels[1].node(0, 1), column * 0.5, 0.02 / 3, 1, 0});
  system.viscous_damping = 16;
  const auto backend = serial_dressing(system);
  const DressingResult result = dress(*backend, system, dressing_dt_s, {}, always);
  EXPECT_LT(fit_of(system, result.state.position, nobody()).largest_gap, 1e-4);
}

/// A sheet hung by its upper edge, of a soft cloth, its lowest row sixty times as heavy as the others.
System heavy_hem(VelocityCorrection correction) {
  System system = garment_of({{12, 8, 0.01, {0, 0, 0}}});
  for (std::uint32_t column = 0; column < 8; ++column) {
    system.node_mass[column] *= 60;
    system.pins.push_back(garment_in(system).panels[0].node(11, column));
  }
  system.materials = {{20, 0}, {6, 0}, {0.8, 0}};
  system.gravity = 9.81;
  system.viscous_damping = 16;
  garment_in(system).dressing.correction = correction;
  return system;
}

double largest_elongation(VelocityCorrection correction) {
  const System system = heavy_hem(correction);
  const double step_s = 2e-4;
  const auto backend = serial_dressing(system, step_s);
  const DressingResult result = dress(*backend, system, step_s, {}, always);
  EXPECT_TRUE(result.settled);
  return fit_of(system, result.state.position, nobody()).elongation_max;
}

TEST(Dressing, LeavesOfAHeavyHemsElongationWhatTheCorrectionAllows) {
  // A node of the hem weighs 60 * 0.4 kg/m^2 * (1 cm)^2 * g = 24 mN, which strains a spring of 20 N/m and 1
  // cm by 12 %; shear and bending springs help a little. Taking away what lengthens a spring that is too long
  // only slows it down: it creeps to where it would hang anyway.
  const double none = largest_elongation(VelocityCorrection::none);
  const double published = largest_elongation(VelocityCorrection::published);
  const double bounded = largest_elongation(VelocityCorrection::bounded);
  EXPECT_NEAR(none, 0.11, 0.01);
  EXPECT_NEAR(published, 0.11, 0.01);
  EXPECT_LT(bounded, 0.065);
}

TEST(Dressing, CorrectsAlongRowsColumnsAndDiagonals) {
  const System system = garment_of({{3, 4, 0.01, {0, 0, 0}}, {2, 2, 0.01, {1, 0, 0}}});
  const auto order = correction_order(garment_in(system), system.springs);
  // Structural 2rc - r - c and shear 2(r-1)(c-1) of 3 x 4 and of 2 x 2, each once.
  EXPECT_EQ(order.size(), 17U + 12 + 4 + 2);
  auto sorted = order;
  std::ranges::sort(sorted);
  EXPECT_TRUE(std::ranges::adjacent_find(sorted) == sorted.end());
  const Spring& second = system.springs[order[1]];
  EXPECT_EQ(second.first, 1U);
  EXPECT_EQ(second.second, 2U);
}

TEST(Dressing, IsTheReferenceButForRounding) {
  System system = two_squares();
  system.gravity = 9.81;
  const auto reference = reference_dressing(system);
  reference->step(400);
  const auto expect_near = [&](std::unique_ptr<DressingBackend> backend, std::string_view name) {
    backend->step(400);
    EXPECT_EQ(backend->progress().draping, reference->progress().draping) << name;
    EXPECT_LT(largest_distance(backend->state().position, reference->state().position), 1e-5) << name;
  };
  expect_near(serial_dressing(system), "serial");
  for (const std::string_view instruction_set : openmp_instruction_sets())
    expect_near(make_openmp_dressing(system, semi_euler, dressing_dt_s,
                                     {.threads = 1, .instruction_set = std::string(instruction_set)}),
                instruction_set);
}

/// Steps a garment into its draping by one thread and by several, and returns where one thread has got.
State state_of_any_number_of_threads(const System& system, double dt_s, int steps) {
  const auto run = [&](int threads) {
    const auto backend = openmp_dressing(system, threads, dt_s);
    backend->step(steps);
    EXPECT_TRUE(backend->progress().draping);
    return backend->state();
  };
  State one = run(1);
  for (const int threads : {2, 3, 5, 8}) EXPECT_TRUE(same_state(run(threads), one)) << threads;
  return one;
}

TEST(Dressing, GivesTheSameBitsForAnyNumberOfThreads) {
  const System system = stretched_sheets();
  const State state = state_of_any_number_of_threads(system, dressing_dt_s, 2000);
  EXPECT_GT(fit_of(system, state.position, nobody()).elongation_max, 0.05) << "nothing is corrected";
}

TEST(Dressing, GivesTheSameBitsWhereFewerThreadsAreGivenThanAskedFor) {
  const System system = stretched_sheets();
  const auto one = openmp_dressing(system, 1);
  const auto limited = openmp_dressing(system, 3);
  one->step(500);
  limited->step(250);
  const int levels = omp_get_max_active_levels();
  omp_set_max_active_levels(1);
#pragma omp parallel num_threads(2)
#pragma omp single
  limited->step(250);  // in a team of one, as OMP_THREAD_LIMIT may have it
  omp_set_max_active_levels(levels);
  EXPECT_TRUE(same_state(limited->state(), one->state()));
}

TEST(Dressing, CorrectsInVectorsAsTheReferenceDoes) {
  for (const VelocityCorrection correction :
       {VelocityCorrection::none, VelocityCorrection::published, VelocityCorrection::bounded}) {
    System system = stretched_sheets();
    garment_in(system).dressing.correction = correction;
    const auto reference = reference_dressing(system);
    reference->step(1200);
    State stretched = reference->state();
    stretched.draped = false;
    round_to_single(stretched);
    const auto soon_after = [&](Backend& backend) {
      backend.set_state(stretched);
      backend.step(20);
      return backend.state().position;
    };
    const std::vector<Vec3d> exact = soon_after(*reference);
    EXPECT_GT(largest_distance(exact, stretched.position), 1e-3);
    const auto single = serial_dressing(system);
    const std::vector<Vec3d> expected = soon_after(*single);
    // A spring that rounding puts on the other side of the threshold is corrected a step earlier or later.
    EXPECT_LT(largest_distance(expected, exact), 2e-5) << static_cast<int>(correction);
    for (const std::string_view instruction_set : openmp_instruction_sets()) {
      const auto vectors = make_openmp_dressing(
          system, semi_euler, dressing_dt_s, {.threads = 2, .instruction_set = std::string(instruction_set)});
      EXPECT_LT(largest_distance(soon_after(*vectors), expected), 3e-7)
          << instruction_set << " " << static_cast<int>(correction);
    }
  }
}

TEST(Dressing, GoesOnFromADrapedStateAsIfItHadSewnItself) {
  const System system = stretched_sheets();
  for (const auto& backend : serial_and_openmp(system)) expect_goes_on_when_draped(*backend, system);
}

// Cloth that comes to rest on a body.

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
  const auto backend = serial_dressing(system, sheet_dt_s);
  return dress(*backend, system, sheet_dt_s, {}, always);
}

Fit fit_on_sphere(const System& system, const State& state) {
  const Solid solid(sphere());
  return fit_of(system, state.position,
                {[&](std::span<const Vec3d> points) { return solid.depths(points); },
                 [](const Vec3d& row) { return std::vector{row}; }});
}

TEST(Drape, ASheetDroppedOnASphereRestsOnItWithNoPointInside) {
  const System system = sheet_above_sphere(0.003);
  const DressingResult result = dropped(system);
  EXPECT_TRUE(result.settled);
  const Fit fit = fit_on_sphere(system, result.state);
  EXPECT_EQ(fit.nodes_inside, 0U);
  EXPECT_EQ(fit.deepest_face_sample, 0);
  // It lies on the sphere's top, maps and the sagitta of its cells above it, and hangs down around it.
  const GarmentPanel& panel = garment_in(system).panels[0];
  EXPECT_NEAR(result.state.position[panel.node(middle, middle)].y, sphere_radius + 0.003, 0.003);
  for (const std::uint32_t corner : {panel.node(0, 0), panel.node(0, 20), panel.node(20, 0)})
    EXPECT_LT(result.state.position[corner].y, 0.05);
}

/// What all steps in which a state has more energy than the one before add, over what the others take.
struct EnergyBalance {
  double gained = 0, lost = 0;
  double fraction() const { return gained / lost; }
};

/// Of steps after the seams have closed.
EnergyBalance draped(const System& system, double dt_s, int steps) {
  const auto backend = serial_dressing(system, dt_s);
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
  // Jeans come to rest 1,617 steps after their seams have closed.
  const DressingCase jeans("jeans4k");
  const EnergyBalance balance = draped(jeans.system, jeans.dt_s(), 1617);
  EXPECT_LT(balance.fraction(), 0.05) << balance.gained << " J of " << balance.lost;
}

TEST(Drape, OnABodyGivesTheSameBitsForAnyNumberOfThreads) {
  const DressingCase jeans("jeans1k");
  state_of_any_number_of_threads(jeans.system, jeans.dt_s(), 800);
}

}  // namespace
}  // namespace mssim
