#include "backends/devices/sub_device.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "backends/backends.h"
#include "backends/devices/offer.h"
#include "integrators/integrators.h"
#include "platform/machine.h"
#include "tests/support/cloth_system.h"
#include "tests/support/garment_system.h"

namespace mssim {
namespace {

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

}  // namespace
}  // namespace mssim
