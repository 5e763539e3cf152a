#include "platform/machine.h"

#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(MemoryShortage, IsNoneWhereTheMemorySuffices) {
  EXPECT_FALSE(memory_shortage(1000, 1000));
  EXPECT_FALSE(memory_shortage(0, available_memory()));
}

TEST(MemoryShortage, NamesBothInTwoDigitsWhereTheseTellThemApart) {
  EXPECT_EQ(memory_shortage(3'200'000'000, 1'000'000'000),
            "needs at least 3.20 GB of memory, but 1.00 GB are available");
}

TEST(MemoryShortage, TakesAsManyDigitsAsTellTheTwoApart) {
  EXPECT_EQ(memory_shortage(384'000'000, 379'000'000),
            "needs at least 0.384 GB of memory, but 0.379 GB are available");
  EXPECT_EQ(memory_shortage(1'000'000'001, 1'000'000'000),
            "needs at least 1.000000001 GB of memory, but 1.000000000 GB are available");
}

TEST(MemoryPeak, IsTheHighestRiseSinceItsBeginning) {
  constexpr std::size_t large = 64 << 20, small = 16 << 20;
  const auto rise_with = [](std::size_t passing, std::size_t lasting) {
    const MemoryPeak peak;
    std::vector<char>(passing, 'x').front() = 'y';
    const std::string kept(lasting, 'x');
    EXPECT_EQ(kept.find_first_not_of('x'), std::string::npos);
    return peak.rise().value();
  };
  EXPECT_NEAR(static_cast<double>(rise_with(large, small)), large, 4e6);
  EXPECT_NEAR(static_cast<double>(rise_with(small, 0)), small, 4e6) << "what was before is forgotten";
}

class MadeUpGroups : public TemporaryFolderTest {
 protected:
  /// Version 2, whose group `root` is mounted.
  void mount_unified(const std::string& root, const std::string& own) const {
    put("proc/self/mountinfo",
        "22 1 8:1 / / rw - ext4 /dev/root rw\n"
        "30 22 0:26 " +
            root + " /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw\n");
    put("proc/self/cgroup", "0::" + own + "\n");
  }
};

TEST_F(MadeUpGroups, OfVersion2AreAskedForTheLeastOnTheWayToTheRoot) {
  mount_unified("/", "/outer/inner");
  put("sys/fs/cgroup/outer/cpu.max", "150000 100000\n");
  put("sys/fs/cgroup/outer/inner/cpu.max", "max 100000\n");
  put("sys/fs/cgroup/outer/memory.max", "2000000\n");
  put("sys/fs/cgroup/outer/memory.current", "1900000\n");
  put("sys/fs/cgroup/outer/memory.stat", "anon 1\ninactive_file 100000\nactive_file 50000\n");
  put("sys/fs/cgroup/outer/inner/memory.max", "1000000\n");
  put("sys/fs/cgroup/outer/inner/memory.current", "300000\n");
  const ContainerLimits limits = container_limits(folder());
  EXPECT_EQ(limits.processors, 1.5);
  EXPECT_EQ(limits.memory_bytes, 1'000'000U);
  EXPECT_EQ(limits.memory_left, 250'000U) << "of the outer group, whose copies of files can go";
}

TEST_F(MadeUpGroups, OfVersion2AreSeenFromWithinAContainer) {
  mount_unified("/docker/abc", "/docker/abc/job");
  put("sys/fs/cgroup/cpu.max", "50000 100000\n");
  put("sys/fs/cgroup/job/cpu.max", "25000 100000\n");
  EXPECT_EQ(container_limits(folder()).processors, 0.25);
  mount_unified("/docker/abc", "/elsewhere");
  EXPECT_EQ(container_limits(folder()).processors, 0.5);
  mount_unified("/", "/../outside");
  EXPECT_EQ(container_limits(folder()).processors, 0.5);
}

TEST_F(MadeUpGroups, OfVersion1HaveAHierarchyForEachController) {
  put("proc/self/mountinfo",
      "31 22 0:27 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
      "32 22 0:28 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
      "33 22 0:29 / /sys/fs/cgroup/systemd rw - cgroup cgroup rw,name=systemd\n");
  put("proc/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/b\n1:name=systemd:/c\n0::/d\n");
  put("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  put("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "300000\n");
  put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n");
  put("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  put("sys/fs/cgroup/memory/b/memory.limit_in_bytes", "5000000\n");
  put("sys/fs/cgroup/memory/b/memory.usage_in_bytes", "4000000\n");
  put("sys/fs/cgroup/memory/b/memory.stat", "inactive_file 7\ntotal_inactive_file 500000\n");
  const ContainerLimits limits = container_limits(folder());
  EXPECT_EQ(limits.processors, 3);
  EXPECT_EQ(limits.memory_bytes, 5'000'000U);
  EXPECT_EQ(limits.memory_left, 1'500'000U);
}

TEST_F(MadeUpGroups, MayHaveNoLimitOrBeMissing) {
  EXPECT_FALSE(container_limits(folder()).processors);
  mount_unified("/", "/");
  put("sys/fs/cgroup/cpu.max", "max 100000\n");
  put("sys/fs/cgroup/memory.max", "max\n");
  const ContainerLimits limits = container_limits(folder());
  EXPECT_FALSE(limits.processors);
  EXPECT_FALSE(limits.memory_bytes);
  EXPECT_FALSE(limits.memory_left);
}

TEST(Terminal, IsWhatItsStreamAndTheEnvironmentSay) {
  const StreamFacts usual{.is_terminal = true, .columns = 120, .term = "xterm", .lang = "en_GB.UTF-8"};
  StreamFacts of_unknown_width = usual, pipe = usual, plain = usual, dumb = usual, unknown = usual;
  of_unknown_width.columns = 0;
  pipe.is_terminal = false;
  plain.no_color = "0";  // any value
  dumb.term = "dumb";
  unknown.term = "";
  using Width = std::optional<int>;
  for (const auto& [facts, width, rewrites, colours] : {std::tuple{usual, Width(120), true, true},
                                                        {of_unknown_width, Width(80), true, true},
                                                        {pipe, Width(), false, false},
                                                        {plain, Width(120), true, false},
                                                        {dumb, Width(120), false, false},
                                                        {unknown, Width(120), false, false}}) {
    const Terminal terminal = terminal_with(facts);
    EXPECT_EQ(terminal.width, width);
    EXPECT_EQ(terminal.rewrites, rewrites) << facts.term;
    EXPECT_EQ(terminal.colours, colours) << facts.term << facts.no_color;
    EXPECT_TRUE(terminal.utf8);
  }
}

TEST(Terminal, TakesTheLocaleOfTheFirstVariableThatIsSet) {
  EXPECT_TRUE(terminal_with({.lang = "C.utf8"}).utf8);
  EXPECT_FALSE(terminal_with({.lang = "de_DE.ISO-8859-1"}).utf8);
  EXPECT_FALSE(terminal_with({.lc_ctype = "C", .lang = "C.UTF-8"}).utf8);
  EXPECT_FALSE(terminal_with({.lc_all = "C", .lc_ctype = "C.UTF-8", .lang = "C.UTF-8"}).utf8);
  EXPECT_TRUE(terminal_with({.lc_all = "C.UTF-8", .lc_ctype = "C"}).utf8);
  EXPECT_FALSE(terminal_with({}).utf8);
}

TEST(DeviceName, IsOneThatPeopleKnow) {
  for (const auto& [device, name] :
       {std::pair{"pthread-skylake-avx512-Intel(R) Xeon(R) Processor", "PoCL on Intel(R) Xeon(R) Processor"},
        {"cpu-znver4-AMD EPYC 9R14-based", "PoCL on AMD EPYC 9R14-based"},
        {"pthread-A Processor", "PoCL on A Processor"},
        {"cpu AVX3", "cpu AVX-512"},
        {"cpu AVX2", "cpu AVX2"},
        {"cpu", "cpu"},
        {"cpu-", "cpu-"},
        {"cpu-cortex-a72", "cpu-cortex-a72"},
        {"NVIDIA H100 80GB HBM3", "NVIDIA H100 80GB HBM3"},
        {"", ""}})
    EXPECT_EQ(device_name(device), name);
}

}  // namespace
}  // namespace mssim
