#include "application/bench/bench_run.h"

#include <thread>

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "output/folders/provenance_file.h"
#include "tests/support/testing.h"
#include "tests/support/trace_fixture.h"

namespace mssim {
namespace {

ResultRow row(const std::string& scene, const std::string& backend, int rounds = 3) {
  ResultRow row;
  row.scene = scene;
  row.backend = backend;
  row.integrator = "semi-euler";
  row.rounds = rounds;
  return row;
}

std::string listed(const std::vector<ResultRow>& rows) {
  std::string text;
  for (const ResultRow& row : rows) text += row.scene + row.backend + ' ';
  return text;
}

TEST(BenchRows, ReplaceAScenesRowsWhereTheyStand) {
  std::vector<ResultRow> rows{row("a", "1"), row("a", "2"), row("b", "1"), row("c", "1")};
  EXPECT_EQ(listed(rows_of_scene(rows, "a")), "a1 a2 ");
  EXPECT_EQ(listed(rows_of_scene(rows, "d")), "");
  replace_rows(rows, "b", {row("b", "8"), row("b", "9")});
  EXPECT_EQ(listed(rows), "a1 a2 b8 b9 c1 ");
  replace_rows(rows, "a", {row("a", "3")});
  EXPECT_EQ(listed(rows), "a3 b8 b9 c1 ");
  replace_rows(rows, "d", {row("d", "1"), row("d", "2")});
  EXPECT_EQ(listed(rows), "a3 b8 b9 c1 d1 d2 ");
}

TEST(BenchRows, AreFinishedWhenEachHasItsRoundsOrCannotRun) {
  BenchSettings settings;
  settings.rounds = 3;
  settings.backends = {find_backend("serial"), find_backend("opencl")};
  settings.integrators = {find_integrator("semi-euler")};
  std::vector<ResultRow> rows{row("a", "serial"), row("a", "opencl")};
  EXPECT_FALSE(is_finished(settings, "a", {}, "out"));
  EXPECT_TRUE(is_finished(settings, "a", rows, "out"));
  rows[1].note = "a remark; " + std::string(unchecked_samples);
  EXPECT_FALSE(is_finished(settings, "a", rows, "out"));
  rows[1].note = "a remark";
  rows[1].rounds = 2;
  EXPECT_FALSE(is_finished(settings, "a", rows, "out"));
  rows[1].status = "unavailable: no device";
  EXPECT_TRUE(is_finished(settings, "a", rows, "out"));
  rows.pop_back();
  EXPECT_THROW(is_finished(settings, "a", rows, "out"), UsageError);
}

TEST(BenchRows, AreNotFinishedWithoutTheFramesThatAreAskedFor) {
  BenchSettings settings;
  settings.rounds = 3;
  settings.backends = {find_backend("serial")};
  settings.integrators = {find_integrator("semi-euler")};
  std::vector<ResultRow> rows{row("a", "serial")};
  rows[0].dt_s = 1e-3;
  EXPECT_TRUE(is_finished(settings, "a", rows, "out"));
  settings.fps = 60;
  EXPECT_FALSE(is_finished(settings, "a", rows, "out"));
  rows[0].frame_steps = 33;
  EXPECT_FALSE(is_finished(settings, "a", rows, "out")) << "those of 30 frames per second";
  rows[0].frame_steps = 17;
  EXPECT_TRUE(is_finished(settings, "a", rows, "out"));
  rows[0].frame_steps = {};
  rows[0].note = "draped; frames of 17 steps are not timed: samples of this row end after 9 steps";
  EXPECT_TRUE(is_finished(settings, "a", rows, "out"));
}

ResultRow row(const std::string& backend, const std::string& status, bool verified) {
  ResultRow row;
  row.scene = "cloth";
  row.backend = backend;
  row.integrator = "rk4";
  row.status = status;
  row.verified = verified;
  return row;
}

TEST(BenchVerdict, IsGoodWhereEveryRowThatWasAskedForIsVerified) {
  const BenchVerdict verdict = verdict_of(
      {row("serial", "ok", true), row("opencl", "unavailable: no device", false)}, {"serial"}, {"rk4"});
  EXPECT_EQ(verdict.exit_code, exit_ok);
  EXPECT_THAT(verdict.reasons, IsEmpty());
}

TEST(BenchVerdict, NamesTheRowsThatAreWrongBeforeThoseThatAreMissing) {
  const BenchVerdict verdict =
      verdict_of({row("serial", "ok", true), row("openmp", "failed: off by 1", false),
                  row("hybrid", "ok", false), row("opencl", "unavailable: no device", false)},
                 {"opencl"}, {});
  EXPECT_EQ(verdict.exit_code, exit_not_verified);
  EXPECT_THAT(verdict.reasons, ElementsAre("cloth, openmp, rk4: failed: off by 1",
                                           "cloth, hybrid, rk4: failed: not verified"));
}

TEST(BenchVerdict, NamesWhatWasAskedForAndCouldNotRun) {
  const std::vector<ResultRow> rows{row("serial", "ok", true),
                                    row("opencl", "unavailable: no device", false)};
  const BenchVerdict verdict = verdict_of(rows, {"serial", "opencl"}, {});
  EXPECT_EQ(verdict.exit_code, exit_unavailable);
  EXPECT_THAT(verdict.reasons, ElementsAre("cloth, opencl, rk4: unavailable: no device"));
  EXPECT_EQ(verdict_of({rows[1]}, {}, {"rk4"}).exit_code, exit_unavailable);
}

using Clock = TimeBudget::Clock;

double seconds_until(const std::optional<Clock::time_point>& when) {
  return std::chrono::duration<double>(when.value() - Clock::now()).count();
}

TEST(TimeBudget, IsNoLimitWithoutSeconds) {
  TimeBudget budget(std::nullopt, {{1000, 1000}});
  EXPECT_EQ(budget.begin_scene(), std::nullopt);
}

TEST(TimeBudget, GivesAllScenesAsManyRounds) {
  TimeBudget budget(100, {{10, 1}, {30, 3}});
  // 60 seconds are left for rounds of 1 + 3 seconds: 15 each.
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 10 + 15 * 1, 0.5);
}

TEST(TimeBudget, GivesTheLastSceneAllThatIsLeft) {
  TimeBudget budget(50, {{10, 1}, {10, 1}});
  budget.begin_scene();
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 50, 0.5);
}

TEST(TimeBudget, ReservesNothingForASceneThatIsSkipped) {
  TimeBudget budget(50, {{10, 1}, {10, 1}, {20, 2}});
  budget.skip(1);
  // 20 seconds are left for rounds of 1 + 2 seconds.
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 10 + 20. / 3, 0.5);
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 50, 0.5) << "the skipped one, which needs no rounds";
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 50, 0.5);
}

TEST(TimeBudget, BelievesWhatTheFirstRoundsTook) {
  TimeBudget budget(10, {{0.01, 0.01}, {0.01, 0.01}, {0.01, 0.02}});
  budget.begin_scene();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // at least ten times what was expected
  budget.first_round_done();
  // Of 9.8 seconds 0.2 at least are for preparing two scenes; of the rest this scene has a third.
  const double seconds = seconds_until(budget.begin_scene());
  EXPECT_GT(seconds, 3);
  EXPECT_LT(seconds, 3.4);
}

TEST(TimeBudget, CorrectsTheDeadlineAfterALongPreparation) {
  TimeBudget budget(4, {{0.001, 0.0001}, {0, 0.0001}});
  budget.begin_scene();
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  EXPECT_NEAR(seconds_until(budget.first_round_done()), seconds_until(budget.end()) / 2, 0.1);
}

TEST(TimeBudget, IsRefusedWhereItIsTooShortForARoundOfEach) {
  EXPECT_THROW(TimeBudget(43, {{10, 1}, {30, 3}}), UsageError);
  EXPECT_NO_THROW(TimeBudget(44, {{10, 1}, {30, 3}}));
}

TEST(MeasuredScenes, GoOnWhereOneCannotBeBuiltAnyMore) {
  BenchOptions options;
  options.scenes = {"cloth2500", "cloth4900"};
  options.backends = {"serial"};
  options.integrators = {"semi-euler"};
  options.rounds = 1;
  BenchPlan plan = plan_of(options);
  plan.timed.front().parts.counts.nodes = 1'000'000'000'000'000;  // as if the memory had gone
  BenchResults results(plan);
  TimeBudget budget(plan.time_budget_s, times_of(plan.timed));
  EXPECT_THAT(measure_scenes(plan, budget, StopRequest(), results),
              ElementsAre(AllOf(HasSubstr("cloth2500.json"), HasSubstr("needs at least"))));
  ASSERT_EQ(results.rows().size(), 1U);
  EXPECT_EQ(results.rows().front().scene, "cloth4900");

  plan = plan_of(options);
  plan.timed.pop_back();
  plan.timed.front().parts.counts.nodes = 1'000'000'000'000'000;
  TimeBudget of_one(plan.time_budget_s, times_of(plan.timed));
  EXPECT_THROW(measure_scenes(plan, of_one, StopRequest(), results), ErrorWith<exit_bad_input>);
}

class BenchTraceTest : public TemporaryFolderTest {};

TEST_F(BenchTraceTest, HasTheProvenanceOfTheBench) {
  BenchOptions options;
  options.scenes = {"cloth2500", "cloth4900"};
  options.backends = {"serial"};
  options.integrators = {"semi-euler"};
  options.execution.threads = 2;
  options.rounds = 1;
  options.output.folder = (folder() / "out").string();
  options.output.trace = true;
  BenchPlan plan = plan_of(options);
  BenchResults results(plan);
  TimeBudget budget(plan.time_budget_s, times_of(plan.timed));
  EXPECT_THAT(measure_scenes(plan, budget, StopRequest(), results), IsEmpty());
  const std::string expected = provenance_text(plan.provenance);
  EXPECT_EQ(read_file(folder() / "out/provenance.json"), expected + '\n');
  for (const std::string& scene : options.scenes)
    EXPECT_EQ(text_in(open(folder() / "out/traces" / (scene + "-serial-semi-euler.h5")).get(),
                      "/parameters/provenance"),
              expected);
}

TEST_F(BenchTraceTest, TakesTheTimesFromARowThatFailsAndTheSpeedupsOverIt) {
  BackendInfo broken = baseline_backend();
  broken.make = [](const System&, const Integrator&, double,
                   const ExecutionOptions&) -> std::unique_ptr<Backend> { throw Unavailable("it is gone"); };
  SceneJob job;
  job.backends = {&broken, find_backend("openmp")};
  std::vector<ResultRow> rows{row("cloth", "serial"), row("cloth", "openmp")};
  for (ResultRow& measured : rows) {
    measured.verified = true;
    static_cast<SampleStatistics&>(measured) = {1, 1, 1, 1, 2, 3, 0.5, 4, 1};
  }
  write_file_atomically(folder() / "b.h5", "an earlier trace");
  PreparedScene scene;
  scene.dt_s = 1e-4;
  EXPECT_TRUE(write_bench_traces(
      job, scene, rows, {"a", "b"}, {}, folder(), true,
      {.progress = [](const std::string&, double) {}, .after_round = {}, .stop = [] { return false; }}));
  EXPECT_THAT(rows[0].status, HasSubstr("it is gone"));
  for (const ResultColumn& column : result_columns) {
    const auto* value = std::get_if<std::optional<double> ResultRow::*>(&column.value);
    EXPECT_TRUE(!value || !(rows[0].**value)) << column.name;
  }
  EXPECT_EQ(rows[1].ms_per_step, 1);
  EXPECT_EQ(rows[1].speedup_vs_serial, std::nullopt);
}

}  // namespace
}  // namespace mssim
