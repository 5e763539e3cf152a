// Vectors of openmp also hold places that no node of a cloth has, and springs that do not exist reach them.
#include <gtest/gtest.h>

#include <cstddef>
#include <string_view>

#include "backends/openmp/openmp.h"
#include "backends/spring_list/serial.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_step.h"
#include "tests/support/cloth_system.h"

namespace mssim {
namespace {

void expect_openmp_near_serial(const System& system) {
  const Integrator& euler = *find_integrator("semi-euler");
  const auto serial = make_serial(system, euler, backend_dt_s, {1, ""});
  serial->step(50);
  const State expected = serial->state();
  for (const std::string_view set : openmp_instruction_sets()) {
    const auto openmp = make_openmp(system, euler, backend_dt_s, {2, ""}, set);
    openmp->step(50);
    const State state = openmp->state();
    for (std::size_t i = 0; i < state.position.size(); ++i)
      ASSERT_LT(length(state.position[i] - expected.position[i]), 1e-6) << set << ", node " << i;
  }
}

TEST(OpenMpOnASheetThroughTheOrigin, KeepsWhatIsNotThereFromTheNodes) {
  // Nodes whose coordinates are zero or like each other's, beside places that no node has.
  SceneSpec spec = sheet_spec(37, 23, 0);
  spec.floor.height = -1;
  expect_openmp_near_serial(build_system(spec));
}

TEST(OpenMpOnAClothWithoutAFloor, KeepsWhatIsNotThereFromTheNodes) {
  System system = without_floor(cloth_system(37, 23));
  round_start_to_single(system);
  expect_openmp_near_serial(system);
}

}  // namespace
}  // namespace mssim
