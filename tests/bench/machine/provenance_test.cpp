#include "bench/machine/provenance.h"

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "output/folders/provenance_file.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class MadeUpMachine : public TemporaryFolderTest {
 protected:
  void put_cache(int cpu, int index, const std::string& level, const std::string& type,
                 const std::string& size, const std::string& shared) const {
    const std::string folder =
        "sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/cache/index" + std::to_string(index) + "/";
    put(folder + "level", level + "\n");
    put(folder + "type", type + "\n");
    put(folder + "size", size + "\n");
    put(folder + "shared_cpu_list", shared + "\n");
  }
};

TEST_F(MadeUpMachine, IsReadFromItsFiles) {
  put("proc/cpuinfo",
      "processor\t: 0\nvendor_id\t: AuthenticAMD\ncpu family\t: 25\nmodel\t\t: 17\n"
      "model name\t: A Processor (R) 9000\ncpu MHz\t\t: 3400.125\n");
  put("proc/meminfo", "MemTotal:       16384 kB\nMemFree: 1 kB\n");
  put("proc/loadavg", "0.50 1.25 2.00 1/100 4242\n");
  put("etc/os-release", "ID=x\nPRETTY_NAME=\"Some Linux 12 (name)\"\n");
  put("sys/devices/system/cpu/online", "0-2,5\n");
  put("sys/devices/system/cpu/smt/active", "1\n");
  put("sys/devices/system/node/online", "0-1\n");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
  for (const int cpu : {0, 1, 2, 5}) {
    put_cache(cpu, 0, "1", "Data", "48K", std::to_string(cpu));
    put_cache(cpu, 1, "1", "Instruction", "32K", std::to_string(cpu));
    put_cache(cpu, 2, "3", "Unified", "32M", "0-2,5");
  }
  const Machine machine = read_machine(folder());
  EXPECT_EQ(machine.cpu_model, "A Processor (R) 9000");
  EXPECT_EQ(machine.cpu_generation, "Zen 4");
  EXPECT_EQ(cpu_name(machine), "A Processor (R) 9000, Zen 4");
  EXPECT_EQ(machine.cpu_mhz, 3400.125);
  EXPECT_EQ(machine.logical_cpus, 4);
  EXPECT_EQ(machine.smt, true);
  EXPECT_EQ(machine.numa_nodes, 2);
  EXPECT_EQ(machine.memory_bytes, 16U << 20);
  EXPECT_THAT(machine.load_average, ElementsAre(0.5, 1.25, 2.0));
  EXPECT_EQ(machine.operating_system, "Some Linux 12 (name)");
  EXPECT_EQ(machine.governor, "performance");
  ASSERT_EQ(machine.caches.size(), 3U);
  EXPECT_EQ(machine.caches[0].type, "Data");
  EXPECT_EQ(machine.caches[0].bytes, 48U << 10);
  EXPECT_EQ(machine.caches[0].count, 4);
  EXPECT_EQ(machine.caches[0].sharing, 1);
  EXPECT_EQ(machine.caches[2].level, 3);
  EXPECT_EQ(machine.caches[2].bytes, 32U << 20);
  EXPECT_EQ(machine.caches[2].count, 1);
  EXPECT_EQ(machine.caches[2].sharing, 4);
}

TEST_F(MadeUpMachine, MayHideEverything) {
  const Machine machine = read_machine(folder() / "nothing");
  EXPECT_EQ(machine.cpu_model, "");
  EXPECT_EQ(machine.governor, std::nullopt);
  EXPECT_EQ(machine.smt, std::nullopt);
  EXPECT_EQ(machine.numa_nodes, 0);
  EXPECT_TRUE(machine.caches.empty());
  EXPECT_TRUE(machine.load_average.empty());
  EXPECT_EQ(machine.memory_bytes, 0U);
}

TEST_F(MadeUpMachine, OfArmIsNamedByItsNumbers) {
  put("proc/cpuinfo", "processor : 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n");
  EXPECT_EQ(cpu_name(read_machine(folder())), "implementer 0x41 part 0xd0c, Neoverse N1");
}

TEST(CpuGeneration, IsToldByMakerFamilyAndModel) {
  EXPECT_EQ(cpu_generation("AuthenticAMD", 0x19, 0x11), "Zen 4");
  EXPECT_EQ(cpu_generation("AuthenticAMD", 0x19, 0x21), "Zen 3");
  EXPECT_EQ(cpu_generation("AuthenticAMD", 0x1a, 0x02), "Zen 5");
  EXPECT_EQ(cpu_generation("GenuineIntel", 6, 0x8f), "Sapphire Rapids");
  EXPECT_EQ(cpu_generation("GenuineIntel", 6, 0xff), "");
  EXPECT_EQ(cpu_generation("0x41", 0, 0xd40), "Neoverse V1");
  EXPECT_EQ(cpu_generation("", 0, 0), "");
}

TEST(Provenance, TellsWhatRanWhereAndHow) {
  setenv("OMP_PLACES", "cores", 1);
  Provenance provenance = gather_provenance({"/opt/x/bin/mssim", "bench", "--threads", "2"}, 2);
  unsetenv("OMP_PLACES");
  add_scene(provenance, "cloth2500", "foobar");
  provenance.opencl_devices = {"platform / device / driver"};
  provenance.tetgen = "1.5";
  const nlohmann::json json = nlohmann::json::parse(provenance_text(provenance));
  EXPECT_THAT(json["command_line"], ElementsAre("mssim", "bench", "--threads", "2"));
  EXPECT_EQ(json["build"]["commit"], build_info().commit);
  EXPECT_EQ(json["build"]["compiler"], build_info().compiler);
  EXPECT_EQ(json["program_fnv1a_64"].get<std::string>().size(), 16U);
  EXPECT_EQ(json["threads"]["asked_for"], 2);
  EXPECT_EQ(json["threads"]["environment"]["OMP_PLACES"], "cores");
  EXPECT_GE(json["threads"]["allowed_cpus"].size(), 1U);
  EXPECT_GE(json["cpu"]["logical_cpus"], 1);
  EXPECT_GT(json["memory_bytes"], 1 << 20);
  EXPECT_EQ(json["scenes_fnv1a_64"]["cloth2500"], "85944171f73967e8");
  EXPECT_EQ(json["opencl_devices"][0], "platform / device / driver");
  EXPECT_EQ(json["tetgen"], "1.5");
  EXPECT_THAT(json["started_utc"].get<std::string>(),
              testing::MatchesRegex("20[0-9]{2}-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-6][0-9]Z"));
}

TEST_F(MadeUpMachine, KnowsProgramsOfAnySizeByTheirHash) {
  constexpr std::uintmax_t large = (std::uintmax_t{64} << 20) + 1;
  const auto files_of = [&] {
    Provenance provenance;
    add_program(provenance, {"mine", {"./program", "data", "--fast"}}, folder() / "program", folder());
    return provenance.backend_programs.front().files;
  };
  for (const char* name : {"program", "data"}) {
    put(name, "text");
    std::filesystem::resize_file(folder() / name, large);
  }
  const std::vector<FileHash> before = files_of();
  ASSERT_EQ(before.size(), 2U);
  EXPECT_EQ(before[0].name, "./program");
  EXPECT_EQ(before[1].name, "data");
  const auto changed = std::filesystem::last_write_time(folder() / "program");
  put("program", "next");
  std::filesystem::resize_file(folder() / "program", large);
  std::filesystem::last_write_time(folder() / "program", changed);
  std::filesystem::last_write_time(folder() / "data", changed + std::chrono::seconds(1));
  const std::vector<FileHash> now = files_of();
  EXPECT_NE(now[0].fnv1a_64, before[0].fnv1a_64) << "of the program's content";
  EXPECT_NE(now[1].fnv1a_64, before[1].fnv1a_64) << "of the time when an argument's file changed";
  put("program", "a");
  EXPECT_EQ(to_hex(files_of()[0].fnv1a_64), "af63dc4c8601ec8c") << "published for FNV-1a";
}

TEST(Provenance, NamesNeitherTheHomeFolderNorTheRestOfTheEnvironment) {
  setenv("MSSIM_TEST_TOKEN", "hush-hush", 1);
  const char* variable = std::getenv("HOME");
  const std::string home = variable ? variable : "";
  setenv("HOME", "/home/jane_doe", 1);
  const std::string json =
      nlohmann::json::parse(provenance_text(gather_provenance(
                                {"/home/jane_doe/mssim/bin/mssim", "bench", "--out=/home/jane_doe/results",
                                 "/home/jane_doe2", "/home/jane_doe"},
                                1)))
          .dump();
  setenv("HOME", home.c_str(), 1);
  unsetenv("MSSIM_TEST_TOKEN");
  EXPECT_THAT(json, Not(HasSubstr("hush-hush")));
  EXPECT_THAT(json, HasSubstr(R"(["mssim","bench","--out=~/results","/home/jane_doe2","~"])"));
}

TEST(Provenance, KnowsHowManyProcessorsABackendWasAskedToUse) {
  Provenance provenance;
  provenance.threads = 3;
  provenance.backend_programs = {{"mine", {"./mine"}}, {.name = "mpi", .ranks = 4, .rank_threads = 2}};
  provenance.backend_programs.push_back({"./a:2", {"./a:2"}});
  EXPECT_EQ(asked_processors(provenance, "openmp").count, 3);
  EXPECT_EQ(asked_processors(provenance, "openmp:2").count, 2);
  EXPECT_EQ(asked_processors(provenance, "openmp:2").backend, "openmp");
  EXPECT_EQ(asked_processors(provenance, "mine").count, 3);
  EXPECT_EQ(asked_processors(provenance, "mpi").count, 8);
  EXPECT_EQ(asked_processors(provenance, "./a:2").count, 3) << "a program that is called so";
}

TEST(BuildInfo, NamesTheCommitInFullOrSaysThatItIsUnknown) {
  const std::string_view commit = build_info().commit;
  if (commit == "unknown") {
    EXPECT_FALSE(build_info().dirty) << "without a commit there is nothing to differ from";
  } else {
    EXPECT_EQ(commit.size(), 40U);
    EXPECT_EQ(commit.find_first_not_of("0123456789abcdef"), std::string_view::npos) << commit;
  }
}

TEST(BuildInfo, TellsTheFlagsAndTheBuildTypeThatItWasCompiledWith) {
  std::string flags(build_info().flags);
  flags.insert(0, 1, ' ').push_back(' ');
#ifdef __OPTIMIZE__
  EXPECT_THAT(flags, Not(HasSubstr(" -O0 ")));
  EXPECT_THAT(flags, HasSubstr(" -O"));
#else
  for (const char* level : {" -O1 ", " -O2 ", " -O3 "}) EXPECT_THAT(flags, Not(HasSubstr(level)));
#endif
#ifdef NDEBUG
  EXPECT_THAT(flags, HasSubstr(" -DNDEBUG "));
#else
  EXPECT_THAT(flags, Not(HasSubstr(" -DNDEBUG ")));
#endif
  EXPECT_THAT(flags, HasSubstr(" -fopenmp"));
  EXPECT_THAT(flags, HasSubstr(" -ffp-contract=off "));
  EXPECT_THAT(flags, Not(HasSubstr("$<"))) << "an expression that CMake left unevaluated";
  EXPECT_FALSE(build_info().build_type.empty());
}

TEST(BuildInfo, TellsTheCompilerThatItWasCompiledWith) {
  const std::string compiler(build_info().compiler);
#if defined(__clang__)
  const std::string version = __clang_version__;  // Debian's ends with a blank
  EXPECT_EQ(compiler, "Clang " + version.substr(0, version.find(' ')));
#elif defined(__GNUC__)
  EXPECT_EQ(compiler, "GNU " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
                          std::to_string(__GNUC_PATCHLEVEL__));
#endif
}

Provenance quiet() {
  Provenance provenance;
  provenance.threads = 4;
  provenance.allowed_cpus = {0, 1, 2, 3};
  provenance.thread_places = {{0}, {1}, {2}, {3}};
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
  provenance.thread_places = {};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("OMP_PROC_BIND=true")));
  provenance.thread_places = {{0, 1}, {2, 3}};
  EXPECT_THAT(noise_of(provenance),
              ElementsAre(AllOf(HasSubstr("2 logical CPUs"), HasSubstr("OMP_PLACES=threads"))));
  provenance.machine.smt = true;  // each place is a core
  EXPECT_THAT(noise_of(provenance), ElementsAre());
  provenance.thread_places = {{0, 1, 2, 3}};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("4 logical CPUs")));
  provenance.thread_places = {};
  provenance.threads = 1;
  EXPECT_THAT(noise_of(provenance), ElementsAre());
}

TEST(Noise, ComesFromThreadsOnOneCpu) {
  Provenance provenance = quiet();
  provenance.thread_places = {{2}};
  EXPECT_THAT(noise_of(provenance),
              ElementsAre(AllOf(HasSubstr("4 threads on 1 logical CPU:"), HasSubstr("OMP_PROC_BIND=true"))));
  provenance.threads = 1;
  EXPECT_THAT(noise_of(provenance), ElementsAre());
  // One CPU is all that the process has: another sentence says so.
  provenance.threads = 2;
  provenance.allowed_cpus = {2};
  EXPECT_THAT(noise_of(provenance), ElementsAre(HasSubstr("2 threads share 1 logical CPU")));
}

}  // namespace
}  // namespace mssim
