#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "backends/devices/device_queue.h"
#include "backends/opencl/programs.h"
#include "integrators/integrators.h"

namespace mssim {
namespace {

using ::testing::HasSubstr;

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(GridProgram, HasOneKernelPerStageOfEveryIntegratorOnOneLane) {
  for (const Integrator& integrator : integrators) {
    const std::string text = grid_program_text(integrator, 1);
    EXPECT_EQ(count(text, "__kernel"), static_cast<int>(integrator.stage_count)) << integrator.name;
    for (std::size_t stage = 0; stage < integrator.stage_count; ++stage)
      EXPECT_THAT(text, HasSubstr("__kernel void " + stage_kernel_name(stage) + "(")) << integrator.name;
  }
}

TEST(GridProgram, HasOneKernelThatTakesEveryStageOnMoreLanes) {
  for (const Integrator& integrator : integrators) {
    const std::string text = grid_program_text(integrator, 16);
    EXPECT_EQ(count(text, "__kernel"), 1) << integrator.name;
    EXPECT_THAT(text, HasSubstr("__kernel void " + std::string(steps_kernel_name) + "(")) << integrator.name;
    for (std::size_t stage = 0; stage < integrator.stage_count; ++stage)
      EXPECT_EQ(count(text, "  walk_stage_" + std::to_string(stage) + "("), 1) << integrator.name;
  }
}

TEST(GridProgram, VisitsEverySpringFromBothEndsOnOneLaneAndOnceOnMore) {
  EXPECT_EQ(count(grid_program_text(integrators.front(), 1), "  add_spring(&sum"), 12);
  EXPECT_EQ(count(grid_program_text(integrators.front(), 16), "  add_spring(&force"), 6);
}

TEST(MeshProgram, HasOneKernelPerStageOfEveryIntegrator) {
  for (const Integrator& integrator : integrators)
    for (const std::string& text : {mesh_program_text(integrator, 1), mesh_program_text(integrator, 16),
                                    alike_program_text(integrator, 1), alike_program_text(integrator, 16)}) {
      for (std::size_t stage = 0; stage < integrator.stage_count; ++stage)
        EXPECT_THAT(text, HasSubstr("__kernel void " + stage_kernel_name(stage) + "(")) << integrator.name;
      EXPECT_EQ(text.find("__kernel void " + stage_kernel_name(integrator.stage_count)), std::string::npos);
    }
}

}  // namespace
}  // namespace mssim
