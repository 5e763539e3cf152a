#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench/results/comparison.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Comparability, OfARunWithItselfIsGiven) {
  Provenance provenance = made_up_provenance();
  add_scene(provenance, "cloth2500", "text");
  EXPECT_THAT(differences(provenance, provenance), IsEmpty());
  EXPECT_THAT(differences(table_rows(), table_rows()), IsEmpty());
}

TEST(Comparability, DoesNotDependOnWhatAMachineDoesFromDayToDay) {
  Provenance later = made_up_provenance();
  later.machine.load_average = {7, 7, 7};
  later.machine.cpu_mhz = 1000;
  later.started_utc = "2027-01-31T12:00:00Z";
  later.build.commit = "another";
  later.build.dirty = false;
  later.command_line = {"mssim", "bench", "--out", "x"};
  EXPECT_THAT(differences(made_up_provenance(), later), IsEmpty());
}

TEST(Comparability, SaysWhatDiffers) {
  Provenance other = made_up_provenance();
  other.machine.logical_cpus = 4;
  other.build.compiler = "Clang 14";
  other.build.build_type = "Debug";
  other.build.flags = "-O0";
  other.threads = 3;
  EXPECT_THAT(
      differences(made_up_provenance(), other),
      ElementsAre("the CPU was A Processor with 2 logical CPUs and is A Processor with 4 logical CPUs",
                  "the compiler was GNU 12 and is Clang 14", "the build type was Release and is Debug",
                  "the compiler flags was \"-O3\" and is \"-O0\"", "the number of threads was 2 and is 3"));
  other = made_up_provenance();
  other.machine.cpu_model = "Another";
  EXPECT_THAT(differences(other, made_up_provenance()),
              ElementsAre("the CPU was Another with 2 logical CPUs and is A Processor with 2 logical CPUs"));
}

TEST(Comparability, TellsDesignsOfOneNameApartWhereBothAreKnown) {
  Provenance zen4 = made_up_provenance(), zen5 = made_up_provenance();
  zen4.machine.cpu_generation = "Zen 4";
  zen5.machine.cpu_generation = "Zen 5";
  EXPECT_THAT(differences(zen4, zen5),
              ElementsAre("the CPU was A Processor, Zen 4 with 2 logical CPUs and is "
                          "A Processor, Zen 5 with 2 logical CPUs"));
  EXPECT_THAT(differences(made_up_provenance(), zen5), testing::IsEmpty());
}

TEST(Comparability, HoldsAgainstEachOtherOnlyScenesThatBothHave) {
  Provenance before = made_up_provenance(), now = made_up_provenance();
  before.scenes = {{"a", 1}, {"b", 2}, {"c", 3}};
  now.scenes = {{"d", 4}, {"c", 3}, {"b", 0xabc}};
  EXPECT_THAT(differences(before, now),
              ElementsAre("the hash of scene b was 0000000000000002 and is 0000000000000abc"));
}

TEST(Comparability, SaysOnceThatABackendRanOnAnotherDevice) {
  std::vector<ResultRow> before{measured_row("opencl", 1, {}), measured_row("opencl", 2, {}),
                                measured_row("serial", 3, {})};
  before[1].integrator = "rk4";
  std::vector<ResultRow> now = before;
  now[0].device = now[1].device = "a GPU";
  EXPECT_THAT(differences(before, now), ElementsAre("the device of opencl was cpu and is a GPU"));
}

TEST(Comparability, SaysThatASceneCameOutOtherwise) {
  const std::vector<ResultRow> before{measured_row("openmp", 1, {})};
  std::vector<ResultRow> now = before;
  now[0].springs_unique = 14503;
  EXPECT_THAT(
      differences(before, now),
      ElementsAre(
          "scene cloth2500 was one of 2500 nodes and 14502 springs and is one of 2500 nodes and 14503 "
          "springs"));
}

TEST(Comparability, LeavesOutRowsThatOneRunOnlyHasOrDidNotMeasure) {
  const std::vector<ResultRow> before{measured_row("openmp", 1, {}), measured_row("opencl", 1, {})};
  std::vector<ResultRow> now{measured_row("hybrid", 1, {}), failed_row("opencl", "unavailable: no device")};
  for (ResultRow& row : now) row.device = "another";
  EXPECT_THAT(differences(before, now), IsEmpty());
}

}  // namespace
}  // namespace mssim
