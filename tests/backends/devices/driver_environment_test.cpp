#include "backends/devices/driver_environment.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

/// Two files that register drivers in a folder, and one that does not.
class RegisteredDrivers : public TemporaryFolderTest {
 public:
  RegisteredDrivers(const RegisteredDrivers&) = delete;
  RegisteredDrivers& operator=(const RegisteredDrivers&) = delete;

 protected:
  RegisteredDrivers() {
    for (const char* variable : {"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"}) {
      const char* value = std::getenv(variable);
      before_.emplace_back(variable, value == nullptr ? std::nullopt : std::optional<std::string>(value));
      unsetenv(variable);
    }
    put("b.icd", "libpocl.so.2\n");
    put("a.icd", "/opt/card/libcard.so");
    put("c.icd.old", "libold.so");
  }
  ~RegisteredDrivers() override {
    for (const auto& [variable, value] : before_)
      value ? setenv(variable, value->c_str(), 1) : unsetenv(variable);
  }

  std::vector<std::string> libraries() const {
    std::vector<std::string> found;
    for (const RegisteredDriver& driver : registered_drivers()) found.push_back(driver.shared_library);
    return found;
  }
  using Names = std::vector<std::string>;

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
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

}  // namespace
}  // namespace mssim
