#include "application/bench/bench_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "application/bench/bench_results.h"
#include "application/bench/bench_run.h"
#include "integrators/all_integrators.h"
#include "tests/support/scene_files.h"
#include "tests/support/temporary_folder.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

using testing::SizeIs;

class BenchPlanTest : public TemporaryFolderTest {
 protected:
  BenchPlanTest() {
    options_.scenes = {file_.string()};
    options_.backends = {"serial"};
    options_.integrators = {"semi-euler"};
    options_.execution.threads = 1;
    options_.rounds = 1;
  }

  std::string text_ = text_of(source_file("scenes/cloth2500.json"));
  std::filesystem::path file_ = put("mine.json", text_);
  BenchOptions options_;
};

TEST_F(BenchPlanTest, HoldsWhatABenchOfItsScenesTakes) {
  const BenchPlan plan = plan_of(options_);
  ASSERT_THAT(plan.timed, SizeIs(1));
  const PlannedScene& scene = plan.timed.front();
  EXPECT_EQ(scene.spec.name, "mine");
  EXPECT_EQ(scene.size.nodes, 2500U);
  EXPECT_EQ(scene.memory_bytes, bench_memory_needed(plan.settings, scene.size));
  EXPECT_EQ(scene.time.round, expected_time(plan.settings, scene.size).round);
  EXPECT_FALSE(plan.uses_device);
}

TEST_F(BenchPlanTest, ExpectsOfABackendItsOwnTime) {
  const SceneSize size = plan_of(options_).timed.front().size;
  const auto seconds = [&](const char* backend) {
    return expected_run_time(*find_backend(backend), *find_integrator("semi-euler"), size, 1e6);
  };
  EXPECT_LT(10 * seconds("openmp"), seconds("serial"));
  EXPECT_GT(seconds("threads-mutex"), seconds("serial"));
}

TEST_F(BenchPlanTest, OutlivesTheFilesOfItsScenes) {
  BenchPlan plan = plan_of(options_);
  put("mine.json", "no scene any more");
  BenchResults results(plan);
  TimeBudget budget(plan.time_budget_s, times_of(plan.timed));
  const StopRequest stop;
  measure_scenes(plan, budget, stop, results);
  ASSERT_THAT(results.rows(), SizeIs(1));
  EXPECT_EQ(results.rows().front().status, "ok");
  EXPECT_EQ(results.rows().front().nodes, 2500U);
  ASSERT_THAT(plan.provenance.scenes, SizeIs(1));
  EXPECT_EQ(plan.provenance.scenes.front().fnv1a_64, fnv1a_64(text_));
}

TEST_F(BenchPlanTest, RefusesTwoScenesOfOneName) {
  options_.scenes.push_back(put("other/mine.json", text_).string());
  EXPECT_THROW(plan_of(options_), UsageError);
}

TEST_F(BenchPlanTest, RefusesToTraceOrResumeWithoutAFolder) {
  for (bool BenchOutput::*option : {&BenchOutput::trace, &BenchOutput::resume, &BenchOutput::overwrite}) {
    options_.output = {};
    options_.output.*option = true;
    EXPECT_THROW(plan_of(options_), UsageError);
  }
}

}  // namespace
}  // namespace mssim
