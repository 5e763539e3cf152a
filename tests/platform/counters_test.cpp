#include "platform/counters.h"

#include <linux/perf_event.h>

#include <semaphore>
#include <thread>

#include "tests/support/files_fixture.h"
#include "tests/support/new_pages.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class MadeUpEnergy : public TemporaryFolderTest {
 protected:
  void put_zone(const std::string& zone, const std::string& name, const std::string& energy_uj) const {
    const std::string folder = "sys/class/powercap/" + zone + "/";
    put(folder + "name", name + "\n");
    put(folder + "max_energy_range_uj", "1000000000\n");
    put(folder + "energy_uj", energy_uj);
  }
};

TEST_F(MadeUpEnergy, IsThatOfAllPackagesSinceTheLastCall) {
  put_zone("intel-rapl:0", "package-0", "999000000\n");
  put_zone("intel-rapl:1", "package-1", "5000000\n");
  put_zone("intel-rapl:0:0", "core", "7\n");  // a part of package 0
  put_zone("intel-rapl:2", "psys", "7\n");    // the whole machine
  put_zone("intel-rapl-mmio:0", "package-0", "7\n");
  PackageEnergy energy(folder());
  EXPECT_EQ(energy.obstacle(), "");
  put_zone("intel-rapl:0", "package-0", "2000000\n");  // started again at 1 kJ
  put_zone("intel-rapl:1", "package-1", "5500000\n");
  for (const char* other : {"intel-rapl:0:0", "intel-rapl:2", "intel-rapl-mmio:0"})
    put("sys/class/powercap/" + std::string(other) + "/energy_uj", "70000000\n");
  EXPECT_NEAR(energy.joules().value(), 3.5, 1e-9);
  EXPECT_EQ(energy.joules(), 0);
  put_zone("intel-rapl:1", "package-1", "");
  EXPECT_EQ(energy.joules(), std::nullopt);
}

TEST_F(MadeUpEnergy, IsNoneWithoutCountersOrIfTheyCannotBeRead) {
  PackageEnergy none(folder());
  EXPECT_EQ(none.joules(), std::nullopt);
  EXPECT_THAT(none.obstacle(), HasSubstr("sys/class/powercap"));
  put_zone("intel-rapl:0", "package-0", "5\n");
  put_zone("intel-rapl:1", "package-1", "");  // as if only root could read it
  PackageEnergy unreadable(folder());
  EXPECT_EQ(unreadable.joules(), std::nullopt);
  EXPECT_THAT(unreadable.obstacle(), HasSubstr("intel-rapl:1/energy_uj"));
}

/// Events that Linux itself counts, so that they are there without counters of a processor.
constexpr CountedEvent page_fault{PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS};
constexpr EventCounters::Events of_linux{
    {page_fault, {PERF_TYPE_SOFTWARE, PERF_COUNT_SW_TASK_CLOCK}, page_fault}};

TEST(EventCounters, CountInThreadsThatThereAreAndInNewOnes) {
  EventCounters counters(of_linux);
  if (!counters.obstacle().empty()) GTEST_SKIP() << counters.obstacle();
  std::binary_semaphore may_touch(0), may_end(0), has_touched(0);
  std::thread earlier([&] {
    may_touch.acquire();
    touch_new_pages();
    has_touched.release();
    may_end.acquire();
  });
  touch_new_pages();  // before it counts
  counters.start();
  touch_new_pages();
  std::thread(touch_new_pages).join();
  may_touch.release();
  has_touched.acquire();
  const auto events = counters.stop();
  may_end.release();
  earlier.join();
  ASSERT_TRUE(events);
  EXPECT_GE((*events)[0], 3 * new_pages);
  EXPECT_LT((*events)[0], 3.5 * new_pages);  // and a few of stacks and code
  EXPECT_GT((*events)[1], 0);
  EXPECT_NEAR((*events)[2], (*events)[0], 10);
  EXPECT_FALSE(counters.stop());
}

TEST(EventCounters, SayWhyAnEventCannotBeCounted) {
  EventCounters::Events unknown = of_linux;
  unknown[1].config = 1'000'000;
  EventCounters counters(unknown);
  EXPECT_NE(counters.obstacle(), "");
  if (EventCounters(of_linux).obstacle().empty()) {
    EXPECT_THAT(counters.obstacle(), HasSubstr("no counters"));
  }
  counters.start();
  EXPECT_FALSE(counters.stop());
}

}  // namespace
}  // namespace mssim
