#include "commands/doctor.h"

#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using enum Checkup::State;

/// A machine of eight CPUs, of which the process may use six, for six threads that are bound.
class MadeUpMachineFindings : public TemporaryFolderTest {
 protected:
  MadeUpMachineFindings() {
    put("proc/cpuinfo", "model name\t: A Processor\n");
    put("proc/loadavg", "0.01 0.02 0.03 1/100 4242\n");
    put("sys/devices/system/cpu/online", "0-7\n");
    put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
    provenance.threads = 6;
    provenance.allowed_cpus = {0, 1, 2, 3, 4, 5};
    provenance.thread_places = {{0}, {1}, {2}, {3}, {4}, {5}};
  }
  Checkup finding(const std::string& item) {
    provenance.machine = read_machine(folder());
    const std::vector<Checkup> all = machine_findings(provenance);
    const auto found = std::ranges::find(all, item, &Checkup::item);
    if (found == all.end()) throw std::runtime_error("nothing is said about " + item);
    return *found;
  }

  Provenance provenance;
};

TEST_F(MadeUpMachineFindings, AreOfTheProcessor) {
  EXPECT_THAT(finding("processor").found, AllOf(HasSubstr("A Processor"), HasSubstr("8 logical CPUs")));
  EXPECT_EQ(finding("processor caches").state, limited);
  const std::string cache = "sys/devices/system/cpu/cpu0/cache/index3/";
  put(cache + "level", "3\n");
  put(cache + "type", "Unified\n");
  put(cache + "size", "32768K\n");
  put(cache + "shared_cpu_list", "0-7\n");
  EXPECT_EQ(finding("processor caches").state, ok);
  EXPECT_THAT(finding("processor caches").found, AllOf(HasSubstr("L3"), HasSubstr("32 MiB")));
}

TEST_F(MadeUpMachineFindings, SayWhichCpusThreadsMayUse) {
  Checkup affinity = finding("affinity");
  EXPECT_EQ(affinity.state, limited);
  EXPECT_THAT(affinity.found, HasSubstr("6 of 8"));
  EXPECT_THAT(affinity.remedy, HasSubstr("taskset"));
  provenance.allowed_cpus = {0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(finding("affinity").state, ok);
  EXPECT_EQ(finding("affinity").remedy, "");
  provenance.thread_places = {{0}};
  EXPECT_EQ(finding("affinity").state, limited);
  EXPECT_THAT(finding("affinity").remedy, AllOf(HasSubstr("master"), HasSubstr("OMP_PROC_BIND=true")));
  // Two CPUs are a core only where cores have two.
  provenance.thread_places = {{0, 1}, {2, 3}, {4, 5}};
  EXPECT_EQ(finding("affinity").state, limited);
  put("sys/devices/system/cpu/smt/active", "1\n");
  EXPECT_EQ(finding("affinity").state, ok);
  provenance.thread_places.clear();
  EXPECT_EQ(finding("affinity").state, limited);
  EXPECT_THAT(finding("affinity").remedy, HasSubstr("OMP_PROC_BIND"));
}

TEST_F(MadeUpMachineFindings, SayWhatAContainerLimits) {
  EXPECT_EQ(finding("container limits").state, ok);
  put("proc/self/mountinfo", "30 24 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n");
  put("proc/self/cgroup", "0::/\n");
  put("sys/fs/cgroup/cpu.max", "150000 100000\n");
  EXPECT_EQ(finding("container limits").state, limited);
  EXPECT_THAT(finding("container limits").found, HasSubstr("1.5 processors"));
  put("sys/fs/cgroup/memory.max", "3000000000\n");
  put("sys/fs/cgroup/memory.current", "1000000\n");
  EXPECT_THAT(finding("container limits").found, AllOf(HasSubstr("1.5 processors"), HasSubstr("3 GB")));
  EXPECT_NE(finding("container limits").remedy, "");
}

TEST_F(MadeUpMachineFindings, SayWhatDisturbsTimes) {
  EXPECT_EQ(finding("governor").state, ok);
  EXPECT_EQ(finding("load").state, ok);
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
  put("proc/loadavg", "1.50 0.02 0.03 1/100 4242\n");
  EXPECT_EQ(finding("governor").state, limited);
  EXPECT_EQ(finding("governor").found, "powersave");
  EXPECT_THAT(finding("governor").remedy, HasSubstr("performance"));
  EXPECT_EQ(finding("load").state, limited);
  EXPECT_THAT(finding("load").found, HasSubstr("1.5 "));
}

}  // namespace
}  // namespace mssim
