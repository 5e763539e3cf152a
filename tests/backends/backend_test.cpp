// Every backend against the double-precision reference, for every integrator.
#include <unistd.h>

#include <thread>

#include "backends/backends.h"
#include "backends/layouts/band_grid.h"
#include "backends/openmp/openmp.h"
#include "backends/spring_list/list_backends.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Those of the table, and openmp in double precision.
std::vector<std::string_view> names_of_rows() {
  std::vector<std::string_view> names = names_of(backends());
  names.emplace_back("openmp:double");
  return names;
}

class EachBackendAndIntegrator
    : public testing::TestWithParam<std::tuple<std::string_view, std::string_view>> {
 protected:
  const Integrator& integrator() const { return *find_integrator(std::get<1>(GetParam())); }
  std::unique_ptr<Backend> make(const System& system, int threads = 2) const {
    return maker_of(row_named(std::get<0>(GetParam())))(system, integrator(), backend_dt_of(integrator()),
                                                        {threads, ""});
  }
};

INSTANTIATE_TEST_SUITE_P(Tables, EachBackendAndIntegrator,
                         testing::Combine(testing::ValuesIn(names_of_rows()),
                                          testing::ValuesIn(names_of(integrators))),
                         ByName());

TEST_P(EachBackendAndIntegrator, AgreesWithTheReferenceOnClothsOfAnyShape) {
  // Odd sizes, fewer rows than lanes, single rows and columns: where layouts go wrong.
  for (const auto& [rows, columns] :
       {std::pair{50U, 50U}, {37U, 23U}, {9U, 11U}, {3U, 40U}, {40U, 3U}, {2U, 2U}, {1U, 7U}, {7U, 1U}}) {
    const System system = cloth_system(rows, columns);
    EXPECT_TRUE(agrees(*make(system), system, integrator(), backend_dt_of(integrator())))
        << rows << " x " << columns;
  }
}

/// serial is the measure, and would be compared with itself.
std::vector<std::string_view> names_but_serial() {
  std::vector<std::string_view> names = names_of_rows();
  std::erase(names, "serial");
  return names;
}

class EachOtherBackendAndIntegrator : public EachBackendAndIntegrator {};
INSTANTIATE_TEST_SUITE_P(Tables, EachOtherBackendAndIntegrator,
                         testing::Combine(testing::ValuesIn(names_but_serial()),
                                          testing::ValuesIn(names_of(integrators))),
                         ByName());

TEST_P(EachOtherBackendAndIntegrator, StaysAsNearToTheReferenceAsTheSpringList) {
  for (const System& system : {cloth_system(50, 50), cloth_system(100, 140), solid_block(9, 9, 9)})
    expect_as_near_as_the_spring_list(*make(system), system, integrator(), backend_dt_of(integrator()));
}

TEST_P(EachBackendAndIntegrator, HoldsPinsExactlyWhereverTheyAre) {
  const System system = cloth_system(20, 23, 1, ClothPins{13, 5});
  ASSERT_GE(system.pins.size(), 5U);
  EXPECT_TRUE(pins_hold(system, state_after(*make(system), 50)));
}

TEST_P(EachBackendAndIntegrator, TreatsTheFloorLikeTheReference) {
  const System system = sliding_sheet(20, 17);
  const auto reference = make_reference(system, integrator(), backend_dt_of(integrator()));
  expect_same_bounce(*make(system), *reference, steps_in(integrator(), 0.0015));
}

TEST_P(EachBackendAndIntegrator, StartsAgainFromAStateThatItIsGiven) {
  const System system = cloth_system(12, 19);
  expect_starts_again(*make(system), system, 1e-6, 1e-3);
}

class EachBackendAndIntegratorOnBodies : public EachBackendAndIntegrator {};
INSTANTIATE_TEST_SUITE_P(Tables, EachBackendAndIntegratorOnBodies,
                         testing::Combine(testing::ValuesIn(names_of_rows()),
                                          testing::ValuesIn(names_of(integrators))),
                         ByName());

/// Bodies where layouts go wrong: less than a vector, a node short of full vectors (63), many windows, bodies
/// of unlike materials.
std::vector<System> bodies_of_any_shape() {
  return {solid_block(2, 2, 2), solid_block(3, 4, 5),  solid_block(3, 3, 7),
          solid_block(9, 9, 9), block_and_lone_node(), two_solid_blocks()};
}

TEST_P(EachBackendAndIntegratorOnBodies, AgreesWithTheReference) {
  for (const System& system : bodies_of_any_shape())
    EXPECT_TRUE(agrees(*make(system), system, integrator(), backend_dt_of(integrator())));
}

TEST_P(EachBackendAndIntegratorOnBodies, HoldsPinsExactlyEvenBelowTheFloor) {
  System block = pinned(solid_block(5, 4, 7), {0, 7, 63, 64, 139});
  block.floor.height = 0.504;
  ASSERT_LT(block.start.position[0].y, block.floor.height);
  for (const System& system : {block, alike_bodies(block, 12)}) {  // in slices, and side by side in lanes
    const State state = state_after(*make(system), 50);
    EXPECT_TRUE(pins_hold(system, state));
    EXPECT_NE(state.position[1], system.start.position[1]) << "the others move";
  }
}

TEST_P(EachBackendAndIntegratorOnBodies, TreatsTheFloorLikeTheReference) {
  // A relaxed block whose flat bottom hits the floor, sliding: its nodes land in the same step in any
  // precision.
  constexpr std::uint32_t nx = 5, ny = 3, nz = 7;
  System system = solid_block(nx, ny, nz, 0.00101);
  const auto on_bottom = [](std::size_t node) { return node / nx % ny == 0; };
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    if (on_bottom(i)) system.start.position[i].y = 0.00101;
    system.start.velocity[i] = {0.5, -1, 0.25};
  }
  round_to_single(system.start);
  system = relaxed(system);
  const auto reference = make_reference(system, integrator(), backend_dt_of(integrator()));
  expect_same_bounce(*make(system), *reference, steps_in(integrator(), 0.0015));
}

TEST_P(EachBackendAndIntegratorOnBodies, StartsAgainFromAStateThatItIsGiven) {
  const System system = two_solid_blocks();
  expect_starts_again(*make(system), system, 1e-6, 1e-3);
}

class EachIntegratorOnOpenMp : public testing::TestWithParam<std::string_view> {
 protected:
  const Integrator& integrator() const { return *find_integrator(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Table, EachIntegratorOnOpenMp, testing::ValuesIn(names_of(integrators)), ByName());

/// Steps in which what starts a few millimetres above the floor bounces off it.
int steps_with_a_bounce(const Integrator& integrator) { return steps_in(integrator, 0.03); }

/// A cloth that meets the floor in that time.
System low_cloth(std::uint32_t rows, std::uint32_t columns) { return cloth_system(rows, columns, 0.0035); }

/// Expects the same bits after a bounce with any number of threads.
void expect_same_bits(const System& system, const Integrator& integrator) {
  const double dt_s = backend_dt_of(integrator);
  const auto bounced = [&](int threads) {
    return state_after(*make_openmp(system, integrator, dt_s, {threads, ""}),
                       steps_with_a_bounce(integrator));
  };
  const State expected = bounced(1);
  EXPECT_TRUE(has_met_floor(system, expected));
  for (const int threads : {2, 3, 4, 7})
    EXPECT_TRUE(same_state(bounced(threads), expected)) << threads << " threads";
}

TEST_P(EachIntegratorOnOpenMp, GivesTheSameBitsForEveryNumberOfThreads) {
  for (const auto& [rows, columns] : {std::pair{50U, 50U}, {37U, 23U}, {9U, 11U}, {61U, 80U}}) {
    SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns));
    expect_same_bits(low_cloth(rows, columns), integrator());
  }
}

// As many as large machines have, each with columns or slices of its own. All 192 numbers would take a minute
// and a half, so some are tried.
TEST(OpenMp, GivesTheSameBitsOnUpTo192Threads) {
  const Integrator& euler = *find_integrator("semi-euler");
  System block = solid_block(20, 20, 20);
  block.floor.height = 0.497;
  for (const System& system : {low_cloth(9, 1700), block}) {
    const auto state_on = [&](int threads) {
      const auto simulation = make_openmp(system, euler, backend_dt_of(euler), {threads, ""});
      EXPECT_EQ(simulation->threads(), threads);
      simulation->step(steps_with_a_bounce(euler));
      return simulation->state();
    };
    const State expected = state_on(1);
    EXPECT_TRUE(has_met_floor(system, expected));
    for (int threads = 192; threads > 1; threads -= 1 + threads / 12)
      EXPECT_TRUE(same_state(state_on(threads), expected))
          << threads << " threads, " << system.nodes() << " nodes";
  }
}

/// Calls it where OpenMP gives a thread nobody else: within threads, which have no threads of their own.
template <class Call>
void call_alone(Call call) {
#pragma omp parallel num_threads(2)
#pragma omp single
  call();
}

/// Expects the same bits from this vector code however a cloth is cut.
template <class Bands>
void expect_same_bits_in_any_cut(const StepKernel<Bands>& kernel, const Integrator& integrator) {
  for (const auto& [rows, columns] : {std::pair{37U, 23U}, {9U, 11U}, {61U, 80U}, {1U, 7U}, {7U, 1U}}) {
    const System system = low_cloth(rows, columns);
    const auto& grid = std::get<GridPatch>(system.topology);
    const auto state_after = [&](std::size_t threads, std::size_t steps_per_pass, std::size_t halves,
                                 bool alone) {
      Bands bands(system, grid, integrator, backend_dt_of(integrator), kernel.lanes, threads,
                  {.steps_per_pass = steps_per_pass, .halves = halves});
      bands.set_state(system.start);
      const auto step = [&] {
        kernel.step(bands, steps_with_a_bounce(integrator) + 1);  // the last pass is a short one
      };
      if (alone)
        call_alone(step);
      else
        step();
      return bands.state();
    };
    const State expected = state_after(1, 1, 1, false);
    // A strip may hang in the air again by now.
    EXPECT_TRUE(rows == 1 || has_met_floor(system, expected)) << rows << " x " << columns;
    for (std::size_t steps = 1; steps * integrator.stage_count <= stages_under_way; ++steps)
      for (const std::size_t threads : {1U, 2U, 3U, 4U})
        for (const std::size_t halves : {1U, 2U})
          for (const bool alone : {false, true}) {
            SCOPED_TRACE(testing::Message() << steps << " steps a pass, " << threads << " threads, " << halves
                                            << " halves" << (alone ? ", walked by one thread" : ""));
            EXPECT_TRUE(same_state(state_after(threads, steps, halves, alone), expected));
          }
  }
}

TEST_P(EachIntegratorOnOpenMp, GivesTheSameBitsHoweverItIsCut) {
  expect_same_bits_in_any_cut(step_kernels<BandGrid>(integrator()).front(), integrator());
}

// Of the widest and of the narrowest vectors: SSE4 and NEON have one lane in each half of a folded cloth.
TEST_P(EachIntegratorOnOpenMp, GivesTheSameBitsInDoublePrecisionHoweverItIsCut) {
  const auto kernels = step_kernels<BandGridOf<double>>(integrator());
  expect_same_bits_in_any_cut(kernels.front(), integrator());
  expect_same_bits_in_any_cut(kernels.back(), integrator());
}

TEST(OpenMpOnAnUncommonlyLargeCloth, TakesSeveralStepsInAPass) {
  // Half a last-level cache is exceeded by a cloth's state, 24 bytes a node, on all but a few machines.
  const System small = cloth_system(50, 50), large = cloth_system(1000, 2000);
  const Integrator& euler = *find_integrator("semi-euler");
  EXPECT_EQ(make_openmp(small, euler, backend_dt_s, {2, ""})->steps_per_pass(), 1);
  const int steps = make_openmp(large, euler, backend_dt_s, {2, ""})->steps_per_pass();
  const long cache = sysconf(_SC_LEVEL3_CACHE_SIZE);
  EXPECT_EQ(steps, cache < 2 * 24 * 2'000'000 ? static_cast<int>(stages_under_way) : 1) << cache;
}

TEST_P(EachIntegratorOnOpenMp, GivesTheSameBitsForEveryNumberOfThreadsOnBodies) {
  for (System system : bodies_of_any_shape()) {
    system.floor.height = 0.497;  // it is met on the way
    SCOPED_TRACE(std::to_string(system.nodes()) + " nodes");
    expect_same_bits(system, integrator());
  }
}

TEST_P(EachIntegratorOnOpenMp, IsAtTheReferenceInDoublePrecisionForAnyThreadsAndInstructionSet) {
  std::vector<System> systems = bodies_of_any_shape();
  systems.push_back(alike_bodies(solid_block(4, 4, 5, 0.002), 5));
  for (const auto& [rows, columns] : {std::pair{37U, 23U}, {9U, 11U}, {61U, 80U}, {1U, 7U}, {7U, 1U}})
    systems.push_back(low_cloth(rows, columns));
  const double dt_s = backend_dt_of(integrator());
  for (const System& system : systems) {
    const State expected = state_after(*make_reference(system, integrator(), dt_s), 60);
    std::map<bool, State> by_rounding;  // whether multiply-adds are rounded once
    for (const StepKernel<BandGridOf<double>>& kernel : step_kernels<BandGridOf<double>>(integrator()))
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(testing::Message() << system.nodes() << " nodes, " << kernel.instruction_set << ", "
                                        << threads << " threads");
        const auto backend = make_openmp_in_double(
            system, integrator(), dt_s, {.threads = threads, .instruction_set = kernel.instruction_set});
        const State state = state_after(*backend, 60);
        EXPECT_LT(largest_distance(state.position, expected.position), 1e-13);
        EXPECT_LT(largest_distance(state.velocity, expected.velocity), 1e-9);
        EXPECT_TRUE(same_state(state, by_rounding.try_emplace(kernel.fuses, state).first->second));
      }
  }
}

TEST_P(EachIntegratorOnOpenMp, GivesTheSameBitsOnBodiesWhenThreadsComeLate) {
  System system = solid_block(9, 9, 9);
  system.floor.height = 0.49;
  const auto alone = make_openmp(system, integrator(), backend_dt_of(integrator()), {1, ""});
  // More threads than cores, with chunks for each, and other work on all cores.
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const auto crowd = make_openmp(system, integrator(), backend_dt_of(integrator()),
                                 {static_cast<int>(std::min(3 * cores, 16U)), ""});
  std::vector<std::jthread> neighbours;
  for (unsigned i = 0; i < cores; ++i)
    neighbours.emplace_back([](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
      }
    });
  for (const int steps : {1, 200, 99}) {
    const State expected = state_after(*alone, steps);
    EXPECT_TRUE(same_state(state_after(*crowd, steps), expected));
  }
}

TEST(BackendTable, NamesEachOnceWithItsPaperConfiguration) {
  for (const BackendInfo& backend : backends()) {
    EXPECT_EQ(find_backend(backend.name), &backend);
    EXPECT_FALSE(backend.paper_configuration.empty());
  }
  EXPECT_EQ(find_backend("cuda"), nullptr);
}

TEST(BackendTable, SaysWhyADeviceBackendCannotRun) {
  const ExecutionOptions options{1, "no such device"};
  for (const BackendInfo& backend : backends()) {
    const std::string reason = unavailable_reason(backend, options);
    EXPECT_EQ(reason.empty(), !backend.uses_device) << backend.name;
    if (!backend.uses_device) continue;
    EXPECT_THAT(reason, HasSubstr("no such device"));
    const System system = cloth_system(4, 4);
    EXPECT_THROW(backend.make(system, integrators[0], backend_dt_s, options), Unavailable);
  }
}

}  // namespace
}  // namespace mssim
