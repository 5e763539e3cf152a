#include <linux/perf_event.h>

#include <chrono>
#include <thread>

#include "platform/files.h"
#include "tests/bench/bench_scene_fixture.h"
#include "tests/support/new_pages.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Takes 50 ms and 40 MB to be made, most of which it then frees, and 30 ms for its first step.
class SlowToBegin final : public OtherSerial {
 public:
  explicit SlowToBegin(std::unique_ptr<Backend> serial) : OtherSerial(std::move(serial)) {
    const std::vector<char> passing(40'000'000, 'x');
    std::this_thread::sleep_for(std::chrono::milliseconds(passing.back() == 'x' ? 50 : 0));
  }
  void step(int count) override {
    if (!std::exchange(has_stepped_, true)) std::this_thread::sleep_for(std::chrono::milliseconds(30));
    OtherSerial::step(count);
  }

 private:
  bool has_stepped_ = false;
};
constexpr BackendInfo slow_to_begin = row_of<SlowToBegin>("slow-to-begin");

/// Takes 20 ms for every tenth request of four steps, and little for the others.
class Stuttering final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void step(int count) override {
    if (count == 4 && ++frames % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    OtherSerial::step(count);
  }

  inline static int frames = 0;
};
constexpr BackendInfo stuttering = row_of<Stuttering>("stuttering");

/// A right one for each of whose requests the processors use 3 J.
class Hungry final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void step(int count) override {
    OtherSerial::step(count);
    write_file_atomically(counter, fmt::format("{}\n", used_uj += 3'000'000));
  }

  inline static std::filesystem::path counter;
  inline static std::int64_t used_uj = 0;
};
constexpr BackendInfo hungry = row_of<Hungry>("hungry");

TEST_F(BenchScene, TellsWhatARowTookBeforeItsSamples) {
  take_only({find_backend("serial"), &slow_to_begin});
  const std::vector<ResultRow> rows = run();
  EXPECT_GT(rows[0].setup_s, 0);
  EXPECT_LT(rows[0].setup_s, rows[1].setup_s);
  EXPECT_GT(rows[0].first_step_ms, 0);
  EXPECT_LT(rows[0].peak_memory_bytes, 4'000'000U);
  EXPECT_GE(rows[1].setup_s, 0.05);
  EXPECT_GE(rows[1].first_step_ms, 30);
  EXPECT_LT(rows[1].ms_per_step, 30);
  EXPECT_EQ(rows[1].compile_s, std::nullopt);
  EXPECT_GT(rows[1].peak_memory_bytes, 39'000'000U);
  EXPECT_LT(rows[1].peak_memory_bytes, 50'000'000U);
}

TEST_F(BenchScene, TellsWhichPartOfTheSetupTheDriverCompiled) {
  if (!unavailable_reason(*find_backend("opencl"), job_.execution).empty())
    GTEST_SKIP() << unavailable_reason(*find_backend("opencl"), job_.execution);
  take_only({find_backend("opencl")});
  const ResultRow row = run().front();
  EXPECT_GT(row.compile_s, 0);
  EXPECT_LT(row.compile_s, row.setup_s);
}

TEST_F(BenchScene, TimesSingleFramesIfItIsToldHowMany) {
  take_only({find_backend("serial"), &stuttering});
  EXPECT_EQ(run()[0].frame_steps, std::nullopt);
  job_.fps = 2500;  // 4 steps of 1e-4 s
  Stuttering::frames = 0;
  const std::vector<ResultRow> rows = run();
  EXPECT_EQ(rows[0].frame_steps, 4U);
  EXPECT_GT(rows[0].frame_p50_ms, 0);
  EXPECT_LE(rows[0].frame_p50_ms, rows[0].frame_p95_ms);
  EXPECT_LT(rows[1].frame_p50_ms, 20);
  EXPECT_GE(rows[1].frame_p95_ms, 20);
  EXPECT_GE(rows[1].frame_p99_ms, rows[1].frame_p95_ms);
  EXPECT_GE(Stuttering::frames, timed_frames);
}

TEST_F(BenchScene, SaysOfFramesLongerThanSamplesThatTheyAreNotTimed) {
  job_.integrators.resize(1);
  job_.fps = 4;  // 2,500 steps of 1e-4 s
  for (const ResultRow& row : run()) {
    EXPECT_EQ(row.status, "ok");
    EXPECT_EQ(row.frame_steps, std::nullopt);
    EXPECT_EQ(row.frame_p50_ms, std::nullopt);
    EXPECT_THAT(row.note, AllOf(HasSubstr("2500 steps"), HasSubstr("2000 steps")));
  }
  job_.fps = 1e-4;  // hours, for which no time is put aside
  job_.deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  EXPECT_EQ(run()[0].rounds, job_.rounds);
}

class BenchSceneWithEnergy : public BenchScene, public TemporaryFolder {};

TEST_F(BenchSceneWithEnergy, TellsWhatAStepTakes) {
  const std::filesystem::path zone = path() / "sys/class/powercap/intel-rapl:0";
  std::filesystem::create_directories(zone);
  write_file_atomically(zone / "name", "package-0\n");
  write_file_atomically(zone / "max_energy_range_uj", "262143328850\n");
  write_file_atomically(Hungry::counter = zone / "energy_uj", "0\n");
  job_.root = path();
  take_only({&hungry});
  const ResultRow row = run().front();
  EXPECT_NEAR(row.joules_per_step.value() * row.sample_steps.front(), 3, 1e-9);
  job_.root = path() / "none";
  EXPECT_EQ(run().front().joules_per_step, std::nullopt);
}

/// Uses new memory for every request, in a new thread.
class Spreading final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void step(int count) override {
    OtherSerial::step(count);
    std::thread(touch_new_pages).join();
  }
};
constexpr BackendInfo spreading = row_of<Spreading>("spreading");

TEST_F(BenchScene, TellsWhatTheSystemCountedInAStep) {
  // What Linux counts itself, because this processor may have no counters; and what never happens.
  constexpr CountedEvent page_fault{PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS};
  job_.events = {page_fault, page_fault, {PERF_TYPE_SOFTWARE, PERF_COUNT_SW_DUMMY}};
  if (!EventCounters(job_.events).obstacle().empty()) GTEST_SKIP() << EventCounters(job_.events).obstacle();
  take_only({&spreading});
  const ResultRow row = run().front();
  EXPECT_NEAR(row.cycles_per_step.value() * row.sample_steps.front(), new_pages, 0.1 * new_pages);
  EXPECT_NEAR(row.instructions_per_step.value() * row.sample_steps.front(), new_pages, 0.1 * new_pages);
  EXPECT_EQ(row.cache_misses_per_step, 0);
}

TEST_F(BenchScene, TellsBytesOfAStepASecond) {
  take_only({find_backend("serial")});
  const ResultRow row = run().front();
  // A step reads and writes positions and velocities: 4 vectors of 3 floats for each of 99 nodes, 4,752
  // bytes. A GB/s is 1e6 bytes a millisecond.
  EXPECT_NEAR(row.gigabytes_per_second.value() * row.ms_per_step.value() * 1e6, 4752, 1e-6);
}

/// A program that tells that its numbers are not in single precision.
class NotInSingle final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  bool is_in_single() const override { return false; }
};
constexpr BackendInfo not_in_single = row_of<NotInSingle>("double");

TEST_F(BenchScene, TellsNoBytesOfNumbersThatAreNotInSingle) {
  take_only({&not_in_single});
  const ResultRow row = run().front();
  EXPECT_GT(row.ms_per_step, 0);
  EXPECT_EQ(row.gigabytes_per_second, std::nullopt);
  EXPECT_EQ(row.roofline_fraction, std::nullopt);
}

TEST_F(BenchScene, SaysHowManyProcessorsTheSamplesTook) {
  take_only({find_backend("serial"), &stumbling});
  FailsAt::fails_at = 0;
  const std::vector<ResultRow> rows = run();
  EXPECT_GT(rows[0].processors_used, 0);
  EXPECT_LT(rows[0].processors_used, 1.5);
  EXPECT_GT(rows[1].processors_used, 10) << "half a second for each sample of a tenth of a millisecond";
}

}  // namespace
}  // namespace mssim
