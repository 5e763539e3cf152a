#include <chrono>
#include <ctime>
#include <thread>

#include "bench/verification/reference_cache.h"
#include "platform/files.h"
#include "platform/process.h"
#include "tests/bench/bench_scene_fixture.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A backend that is right until its state has been set a number of times, as a data race may be.
class RightForAWhile final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void set_state(const State& state) override {
    ++sets_;
    OtherSerial::set_state(state);
  }
  State state() const override {
    State state = OtherSerial::state();
    if (sets_ > 12) state.position[3].y = std::numeric_limits<double>::quiet_NaN();
    return state;
  }
  std::string note() const override { return sets_ > 2 ? "tired" : ""; }

 private:
  int sets_ = 0;
};
constexpr BackendInfo flaky = row_of<RightForAWhile>("flaky");

/// What a row looks like that a verification has found wrong.
void fail_row(ResultRow& row, const std::string& status) {
  row.status = status;
  row.verified = false;
}

/// A right one that takes two processors whatever it was asked for, as a device that cannot be divided.
class OnTwoProcessors final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  int threads() const override { return processors; }

  inline static int processors = 2;
};
constexpr BackendInfo undividable = row_of<OnTwoProcessors>("undividable");

/// A right one of several processes: it tells how many steps it has taken since it was asked last.
class CountsSteps final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void step(int count) override {
    steps_ += count;
    OtherSerial::step(count);
  }
  std::optional<Communication> communication() override {
    Communication costs;
    costs.messages = std::exchange(steps_, 0);
    return costs;
  }

 private:
  int steps_ = 0;
};
constexpr BackendInfo counting = row_of<CountsSteps>("counting");

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The baseline, which takes note of how its first steps are asked for, after the one by itself.
class WatchedSerial final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void step(int count) override {
    if (count > 1 && std::exchange(first_steps, count) == 0 && on_first_step) on_first_step();
    OtherSerial::step(count);
  }

  inline static int first_steps = 0;
  inline static std::function<void()> on_first_step;
};
constexpr BackendInfo watched = row_of<WatchedSerial>("serial", BackendRole::baseline);

TEST_F(BenchScene, GivesARowForEveryCombinationAndKeepsEveryRound) {
  const std::vector<ResultRow> rows = run();
  ASSERT_EQ(rows.size(), 4U);
  ASSERT_EQ(kept_.size(), 3U);
  for (const ResultRow& row : rows) {
    EXPECT_EQ(row.status, "ok");
    EXPECT_TRUE(row.verified);
    EXPECT_EQ(row.rounds, 3);
    EXPECT_GE(row.warm_up_trials, 3);
    EXPECT_GT(row.ms_per_step, 0);
    EXPECT_GT(row.roofline_fraction, 0);
    EXPECT_GT(row.speedup_vs_serial, 0);
  }
  EXPECT_EQ(rows[0].backend, "serial");
  EXPECT_EQ(rows[0].speedup_vs_serial, 1);
  EXPECT_EQ(rows[3].integrator, "rk4");
  for (std::size_t round = 0; round < kept_.size(); ++round)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(kept_[round][i].samples_ms.size(), round + 1);
      EXPECT_EQ(kept_[round][i].samples_ms[round], rows[i].samples_ms[round]);
    }
}

TEST_F(BenchScene, TellsByTheHashesOfStatesWhichRowsAreTheSameToTheLastBit) {
  job_.integrators.resize(1);
  const std::vector<ResultRow> one = run();
  job_.execution.threads = 3;
  const std::vector<ResultRow> three = run();
  ASSERT_TRUE(one[1].state_hash);
  EXPECT_EQ(one[1].backend, "openmp");
  EXPECT_EQ(one[1].state_hash, three[1].state_hash);
  EXPECT_NE(one[0].state_hash, one[1].state_hash) << "serial adds in another order";
}

TEST_F(BenchScene, SaysOfARowThatItTookMoreProcessorsThanWereAskedFor) {
  job_.backends = {find_backend("openmp"), &undividable};
  job_.note = "another mesh";
  const std::vector<ResultRow> rows = run();
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].threads, 1);
  EXPECT_EQ(rows[0].note, "another mesh");
  EXPECT_EQ(rows[1].threads, 2);
  EXPECT_EQ(rows[1].note,
            "another mesh; on 2 processors instead of 1: the driver of made up cannot divide it");
  EXPECT_GT(rows[1].roofline_fraction, 0);  // of what two processors can do
  job_.execution.threads = 2;
  EXPECT_EQ(run()[1].note, "another mesh");
}

TEST_F(BenchScene, ComparesNoRowWithPeaksOfMoreThreadsThanMakeSense) {
  take_only({&undividable});
  const int processors = std::exchange(OnTwoProcessors::processors, 4096);
  const ResultRow row = run()[0];
  OnTwoProcessors::processors = processors;
  EXPECT_EQ(row.status, "ok");
  EXPECT_EQ(row.threads, 4096);
  EXPECT_GT(row.gigabytes_per_second, 0);
  EXPECT_EQ(row.roofline_fraction, std::nullopt);
}

TEST_F(BenchScene, CountsTheCostsOfTheStepsThatItTimes) {
  take_only({&counting});
  const ResultRow row = run()[0];
  EXPECT_EQ(row.messages_per_step, row.sample_steps.front());
}

TEST_F(BenchScene, GoesOnWithTheRoundsThatAllCombinationsHave) {
  const std::vector<ResultRow> first = run();
  job_.earlier = first;
  job_.earlier[2].samples_ms.resize(2);  // killed between two files
  job_.earlier[2].sample_steps.resize(2);
  job_.rounds = 5;
  kept_.clear();
  const std::vector<ResultRow> rows = run();
  EXPECT_EQ(kept_.size(), 3U);  // rounds 3, 4 and 5
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].samples_ms.size(), 5U);
    ASSERT_EQ(rows[i].sample_steps.size(), 5U);
    EXPECT_EQ(rows[i].samples_ms[0], first[i].samples_ms[0]);
    EXPECT_EQ(rows[i].samples_ms[1], first[i].samples_ms[1]);
    EXPECT_EQ(rows[i].rounds, 5);
  }
}

TEST_F(BenchScene, NeverTakesSamplesBackThatWereRejected) {
  const std::vector<ResultRow> first = run();
  job_.earlier = first;
  ResultRow& rejected = job_.earlier[1];
  rejected.verified = false;
  rejected.status = "failed: its samples are wrong";
  job_.rounds = static_cast<int>(first[0].samples_ms.size()) + 1;
  std::vector<ResultRow> rows = run();
  EXPECT_EQ(rows[1].status, rejected.status);
  EXPECT_FALSE(rows[1].verified);
  EXPECT_THAT(rows[1].samples_ms, IsEmpty());
  EXPECT_EQ(rows[0].samples_ms[0], first[0].samples_ms[0]);
  EXPECT_EQ(rows[0].rounds, job_.rounds);

  rejected.samples_ms.pop_back();  // it ended while it was measured
  rejected.sample_steps.pop_back();
  rows = run();
  EXPECT_EQ(rows[1].status, "ok");
  EXPECT_EQ(rows[1].rounds, job_.rounds);

  for (ResultRow& row : job_.earlier) {
    row.verified = false;
    row.status = "failed: its samples are wrong";
  }
  EXPECT_TRUE(counts(run()[0])) << "without a row to go on with, all is measured again";
}

TEST_F(BenchScene, StopsWithTheRoundsThatAreComplete) {
  run();
  const int asked_in_all = std::exchange(asked_, 0);
  kept_.clear();
  stop_after_ = asked_in_all - 2;  // in the midst of the last round
  const std::vector<ResultRow> rows = run();
  EXPECT_EQ(kept_.size(), 2U);
  ASSERT_EQ(rows.size(), 4U);
  for (const ResultRow& row : rows) {
    EXPECT_EQ(row.samples_ms.size(), 2U);
    EXPECT_TRUE(has_unchecked_samples(row));
  }
}

TEST_F(BenchScene, GivesNoRowsWhenItIsStoppedBeforeARoundIsComplete) {
  for (stop_after_ = 0; stop_after_ < 9; ++stop_after_) {
    asked_ = 0;
    EXPECT_TRUE(run().empty()) << stop_after_;
  }
  EXPECT_TRUE(kept_.empty());
}

TEST_F(BenchScene, TakesAsManyRoundsAsFitBeforeADeadlineAndAtLeastOne) {
  job_.rounds = 100'000;
  const auto begin = std::chrono::steady_clock::now();
  job_.deadline = begin;
  EXPECT_EQ(run().front().rounds, 1);
  // Verification takes most of that, and takes as long again.
  const auto end = std::chrono::steady_clock::now();
  job_.deadline = end + 2 * (end - begin) + std::chrono::seconds(4);
  EXPECT_GT(run().front().rounds, 3);
}

TEST_F(BenchScene, ObeysADeadlineThatIsMovedAfterARound) {
  job_.rounds = 3;
  job_.deadline = std::chrono::steady_clock::now();
  const auto later = *job_.deadline + std::chrono::minutes(2);
  const std::vector<ResultRow> rows =
      bench_scene(job_, {.progress = [](const std::string&, double) {},
                         .after_round = [&](const std::vector<ResultRow>&) { job_.deadline = later; },
                         .stop = [] { return false; }});
  EXPECT_EQ(rows.front().rounds, 3);
}

TEST_F(BenchScene, OnlySamplesWhatAnEarlierProcessHasVerified) {
  job_.verified = run();
  job_.verified->at(0).position_error = 1e-7;  // not what a verification would find
  job_.verified->at(1).verified = false;
  fail_row(job_.verified->at(2), "failed: not near enough");
  kept_.clear();
  const std::vector<ResultRow> rows = run();
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].status, "ok");
  EXPECT_TRUE(rows[0].verified);
  EXPECT_EQ(rows[0].position_error, 1e-7);
  EXPECT_EQ(rows[0].note, "verified by an earlier process");
  EXPECT_EQ(rows[0].rounds, 3);
  EXPECT_EQ(rows[0].roofline_fraction, std::nullopt);
  EXPECT_EQ(rows[1].status, "failed: not verified");
  EXPECT_EQ(rows[2].status, "failed: not near enough");
  for (const std::size_t wrong : {1UL, 2UL}) {
    EXPECT_FALSE(rows[wrong].verified);
    EXPECT_EQ(rows[wrong].rounds, 0);
  }
  EXPECT_EQ(rows[3].status, "ok");
  EXPECT_EQ(kept_.size(), 3U);
}

TEST_F(BenchScene, DoesNotTakeOverWhatWasVerifiedOfAnotherSystemOrPlace) {
  job_.integrators = {find_integrator("semi-euler")};
  job_.backends = {find_backend("serial")};
  const std::vector<ResultRow> verified = run();
  const auto status_with = [&](auto change) {
    job_.verified = verified;
    change(job_.verified->front());
    const ResultRow row = run().front();
    EXPECT_FALSE(row.verified);
    EXPECT_EQ(row.ms_per_step, std::nullopt);
    return row.status;
  };
  EXPECT_THAT(status_with([](ResultRow& row) { row.threads = 7; }), HasSubstr("with 7 threads was verified"));
  EXPECT_THAT(status_with([](ResultRow& row) { row.device = "a GPU"; }),
              HasSubstr("on a GPU with 1 thread was"));
  EXPECT_THAT(status_with([](ResultRow& row) { row.dt_s = 0.5; }), HasSubstr("in steps of 0.5 s"));
  EXPECT_THAT(status_with([](ResultRow& row) { ++row.nodes; }), HasSubstr("failed: 100 nodes"));
  EXPECT_THAT(status_with([](ResultRow& row) { row.springs_unique = 1; }), HasSubstr("and 1 springs"));
  EXPECT_THAT(status_with([](ResultRow& row) { row.backend = "openmp"; }), HasSubstr("no earlier process"));
}

TEST_F(BenchScene, SaysWhatFailedInTheMidstOfTheRounds) {
  take_only({find_backend("serial"), &flaky});
  job_.rounds = 40;
  const std::vector<ResultRow> rows = run();
  EXPECT_EQ(rows[0].status, "ok");
  EXPECT_EQ(rows[0].rounds, 40);
  EXPECT_THAT(rows[1].status, HasSubstr("failed: "));
  EXPECT_FALSE(rows[1].verified);
  EXPECT_EQ(rows[1].ms_per_step, std::nullopt);
  EXPECT_EQ(rows[0].note, "");
  EXPECT_EQ(rows[1].note, "tired") << "what it has come to say since it was made";
}

TEST_F(BenchScene, TimesAMethodThatGrowsForAsLongAsItCanBeCompared) {
  system_ = cloth_system(10, 10);
  for (SpringMaterial& material : system_.materials) material.damping *= 0.75;
  job_.dt_s = 5e-5;
  job_.integrators = {find_integrator("explicit-euler"), find_integrator("semi-euler")};
  job_.sample_seconds = 0.1;  // of many more steps than are compared, on a busy machine too
  for (const ResultRow& row : run()) {
    EXPECT_EQ(row.status, "ok") << row.integrator << ' ' << row.backend;
    EXPECT_TRUE(row.verified);
    const bool grows = row.integrator == "explicit-euler";
    const auto most = *std::ranges::max_element(row.sample_steps);
    if (grows) {
      EXPECT_LT(most, verification_steps);
    } else {
      EXPECT_GT(most, verification_steps) << row.backend;
    }
    EXPECT_EQ(row.note.find("doubles a rounding") != std::string::npos, grows) << row.note;
  }
}

TEST_F(BenchScene, SaysOfARowThatShortStepsShowLittle) {
  EXPECT_THAT(run()[1].note, Not(HasSubstr("second stretch")));
  job_.dt_s = 1e-6;
  const ResultRow row = run()[1];
  EXPECT_THAT(row.note, HasSubstr("second stretch"));
  EXPECT_THAT(row.note, HasSubstr("of 400 steps"));
}

TEST_F(BenchScene, VerifiesAClothAtRest) {
  SceneSpec spec = cloth_spec(9, 11);
  spec.gravity_m_per_s2 = 0;
  std::get<ClothSpec>(spec.content).ripple = {0, 1, 0};
  system_ = build_system(spec);
  for (const ResultRow& row : run()) EXPECT_EQ(row.status, "ok") << row.integrator << ' ' << row.backend;
}

TEST_F(BenchScene, TellsOfAProgramThatFailsAtAnyCall) {
  take_only({find_backend("serial"), &stumbling});
  FailsAt::fails_at = 0;
  const ResultRow right = run()[1];
  EXPECT_EQ(right.status, "ok");
  EXPECT_EQ(right.note, "settings");
  EXPECT_EQ(right.program_output, "all went well");
  EXPECT_TRUE(FailsAt::rests);
  const int calls = FailsAt::calls;
  ASSERT_GT(calls, 10);
  // While it is made, verified, calibrated and sampled.
  for (int call = 1; call <= calls / 2; ++call) {
    FailsAt::fails_at = call;
    const std::vector<ResultRow> rows = run();
    EXPECT_EQ(rows[0].status, "ok") << call;
    EXPECT_EQ(rows[0].rounds, 3) << call;
    EXPECT_EQ(rows[1].status, "failed: it stumbled") << call;
    EXPECT_FALSE(rows[1].verified) << call;
    EXPECT_EQ(rows[1].ms_per_step, std::nullopt) << call;
    EXPECT_EQ(rows[1].program_output, "oh dear") << call;
  }
}

TEST_F(BenchScene, TellsOfAProgramThatFailsInTheRounds) {
  take_only({find_backend("serial"), &stumbling});
  job_.rounds = 200;
  FailsAt::fails_at = 500;  // trials before the rounds are far fewer
  const std::vector<ResultRow> rows = run();
  EXPECT_EQ(rows[0].rounds, 200);
  EXPECT_EQ(rows[1].status, "failed: it stumbled");
  EXPECT_GT(rows[1].rounds, 0);
  EXPECT_LT(rows[1].rounds, 200);
}

TEST_F(BenchScene, StepsTheBaselineBesideItsReference) {
  system_ = cloth_system(150, 150);  // a reference of some tenths of a second
  job_.backends = {&watched};
  job_.integrators = {find_integrator("rk4")};
  job_.execution.threads = 2;
  WatchedSerial::first_steps = 0;
  bool others_compute = false;
  WatchedSerial::on_first_step = [&] {
    const double before = processor_seconds();
    for (int wait = 0; wait < 200 && !others_compute; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      others_compute = processor_seconds() - before > 0.02;
    }
  };
  stop_after_ = 1;  // once it is verified
  run();
  EXPECT_TRUE(others_compute);
}

TEST_F(BenchScene, EndsWithinTenStepsOfTheBaselineWhenItIsToldTo) {
  job_.backends = {&watched};
  WatchedSerial::first_steps = 0;
  int steps = 0;
  WatchedSerial::on_first_step = [&] {
    steps = WatchedSerial::first_steps;
    note_ending_signal(SIGINT);
  };
  EXPECT_THROW(run(), Interrupted);
  EXPECT_EQ(take_ending_signal(), SIGINT);
  EXPECT_EQ(steps, 10);
}

TEST_F(BenchScene, JudgesTheBaselineAlikeBesideItsReferenceAndBehindIt) {
  job_.backends = {find_backend("serial")};
  job_.rounds = 1;
  const auto agreements = [&](int threads) {
    job_.execution.threads = threads;
    std::vector<Agreement> all;
    for (const ResultRow& row : run()) all.push_back(row);
    return all;
  };
  const auto expect_alike = [&](const char* where) {
    const std::vector<Agreement> behind = agreements(1), beside = agreements(4);
    ASSERT_EQ(beside.size(), 2U) << where;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto serial = find_backend("serial")->make(system_, *job_.integrators[i], job_.dt_s, {});
      const Verification found =
          verify(*serial, system_, run_reference(system_, *job_.integrators[i], job_.dt_s), job_.dt_s);
      for (const Agreement& agreement : {behind[i], beside[i]}) {
        EXPECT_EQ(agreement.state_hash, found.state_hash) << where;
        EXPECT_EQ(agreement.position_error, found.position_error) << where;
        EXPECT_EQ(agreement.energy_drift, found.energy_drift) << where;
      }
    }
  };
  expect_alike("in the air");
  double lowest = system_.start.position.front().y;
  for (const Vec3d& x : system_.start.position) lowest = std::min(lowest, x.y);
  system_.floor.height = lowest - 3e-4;  // it falls onto the floor in 8 ms
  round_start_to_single(system_);
  ASSERT_LT(run_reference(system_, *job_.integrators[0], job_.dt_s).steps, verification_steps);
  expect_alike("where it meets the floor");
}

class BenchSceneWithReferences : public BenchScene, public TemporaryFolder {
 protected:
  BenchSceneWithReferences() {
    job_.references = {.folder = path() / "references", .program_fnv1a_64 = 1, .least_seconds = 0};
    job_.integrators = {find_integrator("semi-euler")};
  }
};

TEST_F(BenchSceneWithReferences, SaysOfARowThatAnEarlierRunHasFoundItsReference) {
  const std::vector<ResultRow> first = run(), second = run();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first[i].note, "");
    EXPECT_EQ(second[i].note, "compared with a reference of an earlier run");
    EXPECT_TRUE(second[i].verified);
    EXPECT_EQ(first[i].position_error, second[i].position_error);
    EXPECT_EQ(first[i].energy_drift, second[i].energy_drift);
  }
}

TEST_F(BenchSceneWithReferences, FailsNoRowByWhatAFileSays) {
  run();
  const std::filesystem::path file = std::filesystem::directory_iterator(job_.references->folder)->path();
  std::string text = read_file(file);
  text.resize(text.size() - 8);
  text[text.size() - 2 - 24 * system_.nodes()] ^= 0x20;  // the exponent of the last coordinate
  const std::uint64_t hash = fnv1a_64(text);
  text.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  write_file_atomically(file, text);
  ASSERT_TRUE(recall_reference(*job_.references, system_, *job_.integrators[0], job_.dt_s).recalled);
  for (const ResultRow& row : run()) {
    EXPECT_EQ(row.status, "ok");
    EXPECT_EQ(row.note, "");
  }
  EXPECT_EQ(run()[0].note, "compared with a reference of an earlier run") << "it was replaced";
}

}  // namespace
}  // namespace mssim
