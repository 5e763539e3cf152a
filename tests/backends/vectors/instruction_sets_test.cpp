// openmp's vector code for every instruction set that this processor has: from four lanes to sixteen.

#include "backends/accumulation/accumulation_methods.h"
#include "backends/accumulation/gather_vectors.h"
#include "backends/backends.h"
#include "backends/layouts/band_grid.h"
#include "backends/openmp/bodies.h"
#include "backends/openmp/openmp.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using testing::ElementsAreArray;

/// Names and lanes of what this processor has, best first, asked of the compiler's library and not of
/// Highway.
std::vector<std::pair<std::string, std::size_t>> expected_kernels() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  std::vector<std::pair<std::string, std::size_t>> sets;
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    sets.emplace_back("AVX3", 16);
  if (avx2) sets.emplace_back("AVX2", 8);
  if (__builtin_cpu_supports("sse4.2")) sets.emplace_back("SSE4", 4);
  return sets;
#elif defined(__aarch64__)
  return {{"NEON", 4}};
#else
  return {{"SCALAR", 1}};
#endif
}

template <class Kernel>
std::vector<std::pair<std::string, std::size_t>> names_and_lanes(const std::vector<Kernel>& kernels) {
  std::vector<std::pair<std::string, std::size_t>> list;
  for (const Kernel& kernel : kernels) list.emplace_back(kernel.instruction_set, kernel.lanes);
  return list;
}

TEST(InstructionSets, AreAllThatThisProcessorHasTheBestFirst) {
  for (const Integrator& integrator : integrators) {
    EXPECT_THAT(names_and_lanes(step_kernels<BandGrid>(integrator)), ElementsAreArray(expected_kernels()));
    EXPECT_THAT(names_and_lanes(step_kernels<SlicedBodies>(integrator)),
                ElementsAreArray(expected_kernels()));
    EXPECT_THAT(names_and_lanes(step_kernels<PaddedRows>(integrator)), ElementsAreArray(expected_kernels()));
  }
}

TEST(InstructionSets, AreTakenAsNamed) {
  for (const System& system : {cloth_system(9, 11), solid_block(3, 4, 5)}) {
    const auto sets = openmp_instruction_sets();
    for (const std::string_view set : sets)
      EXPECT_EQ(make_openmp(system, integrators[0], backend_dt_s,
                            {.threads = 1, .instruction_set = std::string(set)})
                    ->device(),
                "cpu " + std::string(set));
    EXPECT_THROW(make_openmp(system, integrators[0], backend_dt_s, {.threads = 1, .instruction_set = "MMX"}),
                 Unavailable);
  }
}

TEST(InstructionSets, AreTheBestThatHaveTheRootsInEveryBackendWithVectors) {
  const auto sets = openmp_instruction_sets();
  const auto exact = std::ranges::find_if(sets, has_exact_roots);
  ASSERT_NE(exact, sets.end());
  const auto expect_best = [&](const BackendInfo& backend, const System& system,
                               const Integrator& integrator) {
    for (const auto& [roots, set] : {std::pair{Roots::fast, sets.front()}, {Roots::exact, *exact}})
      EXPECT_EQ(
          make_backend(backend, system, integrator, backend_dt_s, {.threads = 1, .roots = roots})->device(),
          "cpu " + std::string(set))
          << backend.name << ", " << integrator.name;
  };
  const System cloth = cloth_system(9, 11), body = solid_block(3, 4, 5);
  for (const Integrator* integrator : all_integrators)
    for (const System& system : {cloth, body}) expect_best(*find_backend("openmp"), system, *integrator);
  for (const AccumulationMethod& method : accumulation_methods())
    if (method.backend.name == "gather-vectors") expect_best(method.backend, cloth, integrators[0]);
}

class EachInstructionSetAndIntegrator
    : public testing::TestWithParam<std::tuple<std::string_view, std::size_t>> {
 protected:
  std::string_view instruction_set() const { return std::get<0>(GetParam()); }
  const Integrator& integrator() const { return integrators[std::get<1>(GetParam())]; }
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachInstructionSetAndIntegrator,
                         testing::Combine(testing::ValuesIn(openmp_instruction_sets()),
                                          testing::Range(std::size_t{0}, integrators.size())),
                         [](const auto& test) {
                           return ByName::of(std::get<0>(test.param),
                                             integrators[std::get<1>(test.param)].name);
                         });

TEST_P(EachInstructionSetAndIntegrator, AgreesWithTheReferenceOnSystemsOfAnyShape) {
  std::vector<System> systems = odd_systems();
  systems.push_back(block_and_lone_node());
  for (const System& system : systems) {
    const auto simulation = make_openmp(system, integrator(), backend_dt_of(integrator()),
                                        {.threads = 2, .instruction_set = std::string(instruction_set())});
    EXPECT_TRUE(agrees(*simulation, system, integrator(), backend_dt_of(integrator())));
  }
}

TEST_P(EachInstructionSetAndIntegrator, GivesTheSameBitsAsTheBestThatRoundsAlike) {
  const auto sets = openmp_instruction_sets();
  const std::string_view best = *std::find_if(sets.begin(), sets.end(), [&](std::string_view other) {
    return fuses(other) == fuses(instruction_set()) &&
           has_exact_roots(other) == has_exact_roots(instruction_set());
  });
  for (System system : odd_systems()) {
    system.floor.height = system.start.position[0].y - 0.001;  // it is met on the way
    const auto end_of = [&](int threads, std::string_view set) {
      return state_after(*make_openmp(system, integrator(), backend_dt_of(integrator()),
                                      {.threads = threads, .instruction_set = std::string(set)}),
                         300);
    };
    EXPECT_TRUE(same_state(end_of(1, best), end_of(2, instruction_set())))
        << best << ", " << system.nodes() << " nodes";
  }
}

}  // namespace
}  // namespace mssim
