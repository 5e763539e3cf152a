#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "backends/devices/device.h"
#include "backends/devices/offer.h"
#include "backends/devices/pocl_settings.h"

namespace mssim {
namespace {

using ::testing::HasSubstr;

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
  try {
    choose_opencl_device(devices, wanted);
  } catch (const Unavailable& error) {
    return error.what();
  }
  return "";
}

TEST(OpenclDevice, OfPoclHasItsThreadsBoundUnlessTheUserSaysOtherwise) {
  const char* const before = std::getenv("POCL_AFFINITY");
  const std::string kept = before != nullptr ? before : "";
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
  before != nullptr ? setenv("POCL_AFFINITY", kept.c_str(), 1) : unsetenv("POCL_AFFINITY");
}

TEST(OpenclDevice, IsChosenByNumberOrByAPartOfItsNameOrPlatformInAnyCase) {
  EXPECT_EQ(choose_opencl_device(some_devices(), "").number, 0);
  EXPECT_EQ(choose_opencl_device(some_devices(), "2").number, 2);
  EXPECT_EQ(choose_opencl_device(some_devices(), "graphics").number, 1);
  EXPECT_EQ(choose_opencl_device(some_devices(), "PROCESSOR 7").number, 0);
  EXPECT_EQ(choose_opencl_device(some_devices(), "free opencl").number, 2);
}

TEST(OpenclDevice, ThatDoesNotExistIsAnsweredWithWhatThereIs) {
  const std::string all =
      "0 (Example Processor 7, Example(R) OpenCL), 1 (Example Graphics 9000, Example(R) OpenCL), 2 (Another "
      "Processor, Free OpenCL)";
  EXPECT_EQ(complaint(some_devices(), "3"), "no OpenCL device has the number 3; there are: " + all);
  EXPECT_EQ(complaint(some_devices(), "99999999999999999999"),
            "no OpenCL device has the number 99999999999999999999; there are: " + all);
  EXPECT_EQ(complaint(some_devices(), "tpu"),
            "no OpenCL device has \"tpu\" in its name or its platform's; there are: " + all);
  EXPECT_EQ(
      complaint(some_devices(), "processor"),
      "several OpenCL devices have \"processor\" in their names or platforms, choose one by its number: "
      "0 (Example Processor 7, Example(R) OpenCL), 2 (Another Processor, Free OpenCL)");
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

}  // namespace
}  // namespace mssim
