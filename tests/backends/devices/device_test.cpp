#include "backends/devices/device.h"

#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "backends/backends.h"
#include "backends/devices/driver_environment.h"
#include "backends/devices/drivers.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "tests/support/files_fixture.h"
#include "tests/support/garment_system.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Two processors and a card.
std::vector<OpenclDevice> some_devices() {
  std::vector<OpenclDevice> devices(3);
  devices[0].name = "Example Processor 7";
  devices[1].name = "Example Graphics 9000";
  devices[2].name = "Another Processor";
  for (OpenclDevice& device : devices) device.platform = "Example(R) OpenCL";
  devices[2].platform = "Free OpenCL";
  for (int i = 0; i < 3; ++i) devices[static_cast<std::size_t>(i)].number = i;
  return devices;
}

std::string complaint(const std::vector<OpenclDevice>& devices, const char* wanted) {
  return sentence_of<Unavailable>([&] { choose_opencl_device(devices, wanted); });
}

TEST(OpenclDevice, IsChosenByNumberOrByAPartOfItsNameOrPlatformInAnyCase) {
  EXPECT_EQ(choose_opencl_device(some_devices(), "").number, 0);
  EXPECT_EQ(choose_opencl_device(some_devices(), "2").number, 2);
  EXPECT_EQ(choose_opencl_device(some_devices(), "graphics").number, 1);
  EXPECT_EQ(choose_opencl_device(some_devices(), "PROCESSOR 7").number, 0);
  EXPECT_EQ(choose_opencl_device(some_devices(), "free opencl").number, 2);
  std::vector<OpenclDevice> devices = some_devices();
  devices[1].name = "pthread-skylake-avx512-AMD EPYC";
  EXPECT_EQ(choose_opencl_device(devices, "PoCL on AMD EPYC").number, 1) << "as tables show it";
}

TEST(OpenclDevice, ThatDoesNotExistIsAnsweredWithWhatThereIs) {
  const auto offers_all =
      AllOf(HasSubstr("; there are: 0 (Example Processor 7, Example(R) OpenCL), 1 (Example "),
            HasSubstr("), 2 (Another Processor, Free OpenCL)"));
  for (const char* wanted : {"3", "99999999999999999999"})
    EXPECT_THAT(complaint(some_devices(), wanted),
                AllOf(HasSubstr(std::string("has the number ") + wanted), offers_all));
  EXPECT_THAT(complaint(some_devices(), "tpu"), AllOf(HasSubstr("has \"tpu\" in its name"), offers_all));
  EXPECT_THAT(complaint(some_devices(), "processor"),
              HasSubstr("choose one by its number: 0 (Example Processor 7, Example(R) OpenCL), 2 ("));
}

TEST(OpenclDevice, MissingAltogetherIsAnsweredWithWhatToInstall) {
  EXPECT_THAT(complaint({}, ""), HasSubstr("pocl-opencl-icd"));
  EXPECT_THAT(complaint({}, "graphics"), HasSubstr("pocl-opencl-icd"));
}

TEST(OpenclDevice, FailuresNameTheCallAndTheError) {
  EXPECT_EQ(opencl_failure("clBuildProgram", CL_BUILD_PROGRAM_FAILURE),
            "the OpenCL call clBuildProgram failed with CL_BUILD_PROGRAM_FAILURE (-11)");
  EXPECT_EQ(opencl_failure("clFinish", -9999),
            "the OpenCL call clFinish failed with an unknown error (-9999)");
}

TEST(OpenclDevice, ListNumbersTheDevicesOfThisMachineInOrder) {
  const auto devices = opencl_offer().devices;
  ASSERT_FALSE(devices.empty());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].number, static_cast<int>(i));
    EXPECT_FALSE(devices[i].name.empty());
    EXPECT_FALSE(devices[i].platform.empty());
    EXPECT_GT(devices[i].compute_units, 0U);
    EXPECT_GE(devices[i].global_memory_bytes, devices[i].max_allocation_bytes);
    EXPECT_GT(devices[i].max_allocation_bytes, 0U);
    // So that what is tested here is what runs there.
    if (devices[i].platform == "Portable Computing Language") {
      EXPECT_EQ(devices[i].type, OpenclDeviceType::cpu);
      EXPECT_EQ(devices[i].host_memory, HostMemory::fine_grained);
    }
  }
}

OpenclDevice processor() { return choose_opencl_device(opencl_offer().devices, ""); }

/// Nanoseconds that each thread of this process but the calling one has run.
std::map<std::string, std::uint64_t> times_of_other_threads() {
  std::map<std::string, std::uint64_t> times;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    if (const std::string number = task.path().filename(); number != std::to_string(gettid()))
      std::ifstream(task.path() / "schedstat") >> times[number];
  return times;
}

/// Threads, the calling one aside, that did much of `work`. PoCL wakes all of its threads for each kernel,
/// those too that may take no part: that is little where kernels are long.
template <class Work>
int busy_threads(Work&& work) {
  const auto before = times_of_other_threads();
  work();
  std::uint64_t all = 0;
  std::map<std::string, std::uint64_t> taken;
  for (const auto& [thread, time] : times_of_other_threads()) {
    const auto known = before.find(thread);
    taken[thread] = time - (known == before.end() ? 0 : known->second);
    all += taken[thread];
  }
  EXPECT_GT(all, 0U);
  return static_cast<int>(std::ranges::count_if(taken, [&](const auto& t) { return 4 * t.second > all; }));
}

TEST(SubDevice, HasTheComputeUnitsThatWereAskedForAndIsAskedForOnce) {
  const OpenclDevice whole = processor();
  if (whole.type != OpenclDeviceType::cpu || whole.compute_units < 2)
    GTEST_SKIP() << "needs a processor with several compute units";
  const OpenclDevice part = part_of(whole, 1);
  EXPECT_EQ(part.compute_units, 1U);
  EXPECT_EQ(threads_of(part), 1);
  EXPECT_NE(part.id, whole.id);
  EXPECT_EQ(part.name, whole.name);
  EXPECT_EQ(part_of(whole, 1).id, part.id);
}

TEST(SubDevice, IsTheDeviceItselfWhereThatHasNoMoreComputeUnits) {
  const OpenclDevice whole = processor();
  for (const int more : {0, 1, 62}) {
    const OpenclDevice part = part_of(whole, static_cast<int>(whole.compute_units) + more);
    EXPECT_EQ(part.id, whole.id) << more;
    EXPECT_EQ(part.compute_units, whole.compute_units) << more;
  }
}

TEST(SubDevice, IsNotMadeOfACardWhoseThreadsAreNotThisMachines) {
  OpenclDevice card = processor();
  card.type = OpenclDeviceType::gpu;
  card.compute_units = 64;
  EXPECT_EQ(part_of(card, 1).id, card.id);
  EXPECT_EQ(part_of(card, 1).compute_units, 64U);
  EXPECT_EQ(threads_of(card), 1);
}

TEST(SubDevice, HasNoMoreThreadsThanThereAreProcessors) {
  OpenclDevice device = processor();
  device.compute_units = 1000;
  EXPECT_EQ(threads_of(device), std::ssize(process_cpus()));
}

TEST(SubDevice, IsTheDeviceItselfWhereTheDriverRefuses) {
  OpenclDevice device = processor();
  device.compute_units = 1000;  // so that it would have to give more than it has
  const OpenclDevice part = part_of(device, 999);
  EXPECT_EQ(part.id, device.id);
  EXPECT_EQ(part.compute_units, 1000U);
}

TEST(SubDevice, KeepsTheBackendsToTheThreadsThatWereAskedFor) {
  const auto units = static_cast<int>(processor().compute_units);
  const System cloth = cloth_system(300, 300), sheet = garment_of({{200, 200, 0.01, {0, 0, 0}}});
  for (const std::string_view name : {"opencl", "hybrid"})
    for (const System* system : {&cloth, &sheet}) {
      if (system == &sheet && name == "hybrid") continue;
      const auto make = [&](int threads) {
        return make_backend(*find_backend(name), *system, integrators.front(), 2e-4, {.threads = threads});
      };
      const auto one = make(1);
      EXPECT_EQ(one->threads(), 1) << name;
      EXPECT_EQ(excess_of(*find_backend(name), *one, {.threads = 1}), "") << name;
      EXPECT_EQ(busy_threads([&] { one->step(100); }), 1) << name;
      EXPECT_EQ(make(units)->threads(), units) << name;
    }
  EXPECT_EQ(find_backend("opencl")->make(cloth, integrators.front(), 2e-4, {.threads = units + 5})->threads(),
            units);
  EXPECT_EQ(find_backend("hybrid")->make(cloth, integrators.front(), 2e-4, {.threads = units + 5})->threads(),
            units + 5);
}

/// Two files that register drivers in a folder, and one that does not.
class RegisteredDrivers : public TemporaryFolderTest {
 protected:
  RegisteredDrivers() {
    for (const char* variable : {"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"}) unsetenv(variable);
    put("b.icd", "libpocl.so.2\n");
    put("a.icd", "/opt/card/libcard.so");
    put("c.icd.old", "libold.so");
  }
  std::vector<std::string> libraries() const {
    std::vector<std::string> found;
    for (const RegisteredDriver& driver : registered_drivers()) found.push_back(driver.shared_library);
    return found;
  }
  using Names = std::vector<std::string>;

 private:
  KeptVariables kept_{"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"};
};

TEST_F(RegisteredDrivers, AreThoseOfAFolderByName) {
  for (const char* variable : {"OPENCL_VENDOR_PATH", "OCL_ICD_VENDORS"}) {
    setenv(variable, folder().c_str(), 1);
    EXPECT_EQ(libraries(), (Names{"/opt/card/libcard.so", "libpocl.so.2"})) << variable;
    unsetenv(variable);
  }
  setenv("OCL_ICD_VENDORS", folder().c_str(), 1);
  EXPECT_FALSE(is_pocl(registered_drivers()[0]));
  EXPECT_TRUE(is_pocl(registered_drivers()[1]));
}

TEST_F(RegisteredDrivers, MayBeOneFileOrOneLibraryInstead) {
  setenv("OPENCL_VENDOR_PATH", folder().c_str(), 1);
  setenv("OCL_ICD_VENDORS", (folder() / "b.icd").c_str(), 1);
  EXPECT_EQ(libraries(), Names{"libpocl.so.2"});
  setenv("OCL_ICD_VENDORS", "/opt/card/libcard.so", 1);
  EXPECT_EQ(libraries(), Names{"/opt/card/libcard.so"});
  setenv("OCL_ICD_VENDORS", "", 1);
  EXPECT_EQ(libraries().size(), 2U);
}

TEST_F(RegisteredDrivers, AreNoneWhereThereIsNoFolder) {
  setenv("OCL_ICD_VENDORS", (folder() / "none" / "x.icd").c_str(), 1);
  EXPECT_EQ(libraries(), Names{""});
  setenv("OCL_ICD_VENDORS", "", 1);
  setenv("OPENCL_VENDOR_PATH", (folder() / "none").c_str(), 1);
  EXPECT_EQ(libraries(), Names{});
}

TEST(Pocl, HasItsThreadsBoundUnlessTheUserSaysOtherwise) {
  const KeptVariables kept{"POCL_AFFINITY"};
  const auto after_binding = [](const char* chosen) {
    chosen != nullptr ? setenv("POCL_AFFINITY", chosen, 1) : unsetenv("POCL_AFFINITY");
    bind_pocl_threads();
    const char* const found = std::getenv("POCL_AFFINITY");
    return std::string(found != nullptr ? found : "");
  };
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  const bool may_use_all = CPU_COUNT(&all) == sysconf(_SC_NPROCESSORS_CONF);
  EXPECT_EQ(after_binding(nullptr), may_use_all ? "1" : "");
  EXPECT_EQ(after_binding("0"), "0");
  if (CPU_COUNT(&all) > 1) {  // a process kept to one core
    std::size_t core = 0;
    while (!CPU_ISSET(core, &all)) ++core;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(after_binding(nullptr), "");
    ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  }
}

}  // namespace
}  // namespace mssim
