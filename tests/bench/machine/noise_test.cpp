#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/machine/provenance.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Provenance quiet() {
  Provenance provenance;
  provenance.threads = 4;
  provenance.allowed_cpus = {0, 1, 2, 3};
  provenance.thread_environment = {{"OMP_PROC_BIND", "true"}};
  provenance.machine.load_average = {0.05, 3, 3};
  provenance.machine.governor = "performance";
  provenance.machine.turbo = false;
  return provenance;
}

TEST(Noise, IsNotSeenOnAQuietMachineOrWhereNothingIsTold) {
  EXPECT_THAT(noise_of(quiet()), ElementsAre());
  EXPECT_THAT(noise_of(Provenance{}), ElementsAre());
}

TEST(Noise, ComesFromLoadGovernorTurboAndThreads) {
  Provenance provenance = quiet();
  provenance.machine.load_average = {1.25, 0, 0};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("load 1.2")));
  provenance.machine.load_average = {0.25, 0, 0};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("load 0.2")));
  provenance.machine.load_average = {0.24, 9, 9};
  EXPECT_THAT(noise_of(provenance), ElementsAre());
  provenance = quiet();
  provenance.machine.governor = "powersave";
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("\"powersave\"")));
  provenance = quiet();
  provenance.machine.turbo = true;
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("turbo is on")));
  provenance = quiet();
  provenance.threads = 5;
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("5 threads share 4 logical CPUs")));
}

TEST(Noise, ComesFromAQuotaThatThreadsExceed) {
  Provenance provenance = quiet();
  provenance.machine.cpu_quota = 4;
  EXPECT_THAT(noise_of(provenance), ElementsAre());
  provenance.machine.cpu_quota = 2.5;
  EXPECT_THAT(noise_of(provenance), ElementsAre(AllOf(HasSubstr("4 threads"), HasSubstr("2.5 processors"),
                                                      HasSubstr("--threads"))));
}

TEST(Noise, ComesFromThreadsThatMayMove) {
  Provenance provenance = quiet();
  provenance.thread_environment = {{"OMP_PROC_BIND", "false"}};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("OMP_PROC_BIND=true")));
  provenance.thread_environment = {};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("OMP_PROC_BIND=true")));
  provenance.thread_environment = {{"OMP_PLACES", "cores"}};
  EXPECT_THAT(noise_of(provenance), ElementsAre());
  provenance.thread_environment = {};
  provenance.threads = 1;
  EXPECT_THAT(noise_of(provenance), ElementsAre());
}

}  // namespace
}  // namespace mssim
