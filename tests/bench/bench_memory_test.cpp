#include "backends/accumulation/accumulation_methods.h"
#include "backends/backends.h"
#include "bench/estimates.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "tests/support/backend_checks.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::vector<BackendInfo> backends_and_ways() {
  std::vector<BackendInfo> all(backends().begin(), backends().end());
  for (const char* name : {"serial:double", "openmp:double"}) all.push_back(row_named(name));
  for (const AccumulationMethod& method : accumulation_methods())
    if (!find_backend(method.backend.name)) all.push_back(method.backend);
  return all;
}

const ExecutionOptions two_threads{2, {}};
constexpr double small_change = 20e6;  // of the runtimes and the heap, whatever the scene

/// Expects that making it with `make`, a step and reading its state back take about as much as stated.
template <class Make>
void expect_as_stated(const Make& make, const MemoryUse& use, const Integrator& integrator,
                      const System& system, std::string_view what) {
  const MemoryPeak peak;
  const auto simulation = make();
  simulation->step(1);
  EXPECT_EQ(simulation->state().position.size(), system.nodes());
  const auto grown = static_cast<double>(peak.rise().value());
  const double stated = use.bytes(integrator, system.nodes(), system.springs.size(), two_threads.threads) +
                        2 * sizeof(Vec3d) * static_cast<double>(system.nodes());
  EXPECT_LT(grown, 1.25 * stated + small_change) << integrator.name << ", " << what;
  EXPECT_GT(grown, 0.75 * stated - small_change) << integrator.name << ", " << what;
}

void expect_as_stated(const BackendInfo& backend, const MemoryUse& use, const System& system) {
  const Integrator& rk4 = *find_integrator("rk4");  // has the most pairs
  const auto make = [&] { return maker_of(backend)(system, rk4, 1e-5, two_threads); };
  make()->step(1);  // what is compiled once
  expect_as_stated(make, use, rk4, system, backend.name);
}

TEST(MemoryUse, IsWhatEveryBackendAndWayTakesForACloth) {
  const System system = cloth_system(1000, 700);
  for (const BackendInfo& backend : backends_and_ways())
    expect_as_stated(backend, memory_of(backend, *find_integrator("rk4"), true), system);
}

TEST(MemoryUse, IsWhatEveryBackendAndWayTakesForBodies) {
  const System system = solid_block(60, 60, 60);
  for (const BackendInfo& backend : backends_and_ways())
    if (backend.name != "gather-vectors")  // refuses bodies
      expect_as_stated(backend, memory_of(backend, *find_integrator("rk4"), false), system);
}

/// On the plain list, in double precision and with vectors.
void expect_implicit_as_stated(std::string_view name, const System& system, bool grid) {
  const Integrator& integrator = *find_integrator(name);
  for (const char* backend_name : {"serial", "openmp"}) {
    const BackendInfo& backend = *find_backend(backend_name);
    expect_as_stated([&] { return make_backend(backend, system, integrator, 1e-5, two_threads); },
                     memory_of(backend, integrator, grid), integrator, system, backend_name);
  }
  expect_as_stated([&] { return make_reference(system, integrator, 1e-5); },
                   reference_memory(integrator, grid), integrator, system, "reference");
}

TEST(MemoryUse, IsWhatImplicitIntegratorsTakeForACloth) {
  const System large = cloth_system(1000, 700), small = cloth_system(300, 400);
  for (const char* name : {"implicit-euler", "newton-euler", "xpbd"})
    expect_implicit_as_stated(name, large, true);
  expect_implicit_as_stated("fast-springs", small, true);  // factorises
}

TEST(MemoryUse, IsWhatImplicitIntegratorsTakeForBodies) {
  const System large = solid_block(60, 60, 60), small = solid_block(24, 24, 24);
  for (const char* name : {"implicit-euler", "newton-euler", "xpbd"})
    expect_implicit_as_stated(name, large, false);
  expect_implicit_as_stated("fast-springs", small, false);
}

SceneJob job_of(const std::vector<std::string_view>& backend_names,
                const std::vector<std::string_view>& integrator_names) {
  SceneJob job;
  for (const std::string_view name : backend_names) job.backends.push_back(find_backend(name));
  for (const std::string_view name : integrator_names) job.integrators.push_back(find_integrator(name));
  job.execution.threads = 2;
  return job;
}

TEST(BenchMemory, HoldsAReferenceForEachThread) {
  const auto needed = [](const std::vector<std::string_view>& integrator_names) {
    return bench_memory_needed(job_of({"openmp"}, integrator_names), {1000, 6000, true});
  };
  // rk4's reference stores three pairs where that of semi-euler stores one, of 48 bytes a node.
  const std::uint64_t rk4 = needed({"rk4"});
  EXPECT_EQ(needed({"rk4", "rk4"}) - rk4, rk4 - (1000U * 56 + 6000U * 16));
  EXPECT_EQ(needed({"rk4", "rk4", "semi-euler"}), needed({"rk4", "rk4"}));
}

TEST(BenchMemory, OfAnImplicitIntegratorIsThatOfItsSolver) {
  // The reference of newton-euler: 249 bytes a node and 40 a spring; the System and three states as above.
  EXPECT_EQ(bench_memory_needed(job_of({"openmp"}, {"newton-euler"}), {1000, 6000, true}),
            1000U * (56 + 249 + 3 * 48) + 6000U * (16 + 40));
  const auto of_size = [](std::uint64_t nodes) {
    return static_cast<double>(
        bench_memory_needed(job_of({"serial"}, {"fast-springs"}), {nodes, 6 * nodes, true}));
  };
  // Factors fill as they grow: serial's and the reference's by six numbers of 24 bytes a node and doubling.
  EXPECT_NEAR(of_size(1U << 20) - 2 * of_size(1U << 19), 2 * 144 * double{1U << 20}, 10);
}

TEST(BenchMemory, HoldsAllCombinationsAtOnce) {
  const SceneSize size{1'000'000, 6'000'000, true};
  const auto needed = [&](const std::vector<std::string_view>& backend_names,
                          const std::vector<std::string_view>& integrator_names) {
    return static_cast<double>(bench_memory_needed(job_of(backend_names, integrator_names), size));
  };
  const double hybrid =
      find_backend("hybrid")->grid_memory.bytes(*find_integrator("semi-euler"), size.nodes, size.springs, 2);
  EXPECT_EQ(needed({"hybrid", "threads-mutex"}, {"semi-euler"}) - needed({"hybrid"}, {"semi-euler"}), 41e6);
  EXPECT_GT(needed({"hybrid"}, {"semi-euler", "rk4"}) - needed({"hybrid"}, {"semi-euler"}), hybrid);
}

TEST(BenchMemory, OfARowBodyByBodyHoldsASystemOfEachBody) {
  const SceneSize size{1'000'000, 6'000'000, false};
  BackendInfo openmp = *find_backend("openmp");
  const auto needed = [&] {
    SceneJob job = job_of({"hybrid"}, {"semi-euler"});
    job.backends.push_back(&openmp);
    return bench_memory_needed(job, size);
  };
  const std::uint64_t together = needed();
  openmp.each_body = true;
  EXPECT_EQ(needed() - together, size.nodes * 56 + size.springs * 16);
}

TEST(BenchMemory, OfAGarmentHoldsTheStatesOfItsReference) {
  const SceneJob job = job_of({"openmp"}, {"semi-euler"});
  // Both ends of 20 stretches while the seams close and of 20 when draped, 48 bytes a node each, instead of
  // one state; 40 errors.
  EXPECT_EQ(bench_memory_needed(job, {1000, 6000, false, true}),
            bench_memory_needed(job, {1000, 6000, false, false}) + 1000U * (79 * 48 + 40 * 8));
}

TEST(BenchMemory, OfSixteenMillionNodesWithAllBackendsFitsInto24GiB) {
  const SceneSize size{16'000'000, 95'960'002, true};
  const std::uint64_t needed = bench_memory_needed(
      job_of({"serial", "threads-mutex", "openmp", "opencl", "hybrid"}, {"semi-euler"}), size);
  EXPECT_LT(needed, std::uint64_t{24} << 30);
  EXPECT_GT(needed, std::uint64_t{10} << 30);  // 12.1 GB at the peak were measured
}

}  // namespace
}  // namespace mssim
