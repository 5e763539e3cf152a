#include "application/bench/bench_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "application/bench/suites.h"
#include "bench/results/result.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "tests/support/files_fixture.h"
#include "text/error.h"

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

std::vector<std::string_view> names_in(const std::vector<const BackendInfo*>& backends) {
  std::vector<std::string_view> names;
  for (const BackendInfo* backend : backends) names.push_back(backend->name);
  return names;
}

TEST_F(BenchPlanTest, HasARowForEachNumberOfThreadsButOfABackendOfOneThread) {
  options_.backends = {"serial", "openmp", "threads-mutex"};
  options_.threads = {2, 1};
  options_.execution.threads = 2;
  BenchPlan plan = plan_of(options_);
  EXPECT_THAT(names_in(plan.timed.front().backends),
              testing::ElementsAre("serial", "threads-mutex:1", "threads-mutex", "openmp:1", "openmp"));
  EXPECT_EQ(plan.provenance.threads, 2);
  const System system = plan.timed.front().prepare().system;
  for (const BackendInfo* backend : plan.timed.front().backends) {
    const auto made =
        make_backend(*backend, system, *find_integrator("semi-euler"), 1e-4, plan.settings.execution);
    EXPECT_EQ(made->threads(),
              backend->role == BackendRole::baseline || backend->name.ends_with(":1") ? 1 : 2)
        << backend->name;
  }
}

TEST_F(BenchPlanTest, HasARowOnceThatIsNamedByItselfToo) {
  options_.backends = {"openmp:1", "openmp"};
  options_.threads = {1, 2};
  options_.execution.threads = 2;
  const BenchPlan plan = plan_of(options_);
  std::vector<std::string_view> names;
  for (const BackendInfo* backend : plan.settings.backends) names.push_back(backend->name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("openmp:1", "openmp"));
}

TEST_F(BenchPlanTest, TakesABackendOnItsOwnNumberOfThreads) {
  options_.backends = {"openmp:2", "openmp"};
  EXPECT_THAT(names_in(plan_of(options_).settings.backends), testing::ElementsAre("openmp", "openmp:2"));
  for (const char* wrong : {"serial:2", "openmp:0", "openmp:x", "openmp:4000"}) {
    options_.backends = {wrong};
    EXPECT_THROW(plan_of(options_), UsageError) << wrong;
  }
}

std::vector<std::string_view> backends_of(std::string_view suite) {
  return names_in(comparison_of_suite(suite).backends());
}

TEST(Suites, NameScenesAndIntegratorsThatExist) {
  for (const Suite& suite : suites()) {
    for (const std::string_view scene : suite.scenes)
      EXPECT_TRUE(is_scene(scene)) << suite.name << ": " << scene;
    for (const std::string_view integrator : suite.comparison.integrators)
      EXPECT_NE(find_integrator(integrator), nullptr) << suite.name << ": " << integrator;
    EXPECT_FALSE(suite.comparison.integrators.empty() || suite.comparison.backends().empty()) << suite.name;
  }
}

TEST(Suites, CompareWithTheBackendThatResultsCallTheBaseline) {
  EXPECT_EQ(baseline_backend().name, baseline_name);
}

TEST(Suites, CalledTablesAreThoseOfThePaperAlone) {
  std::set<std::string> in_tables, in_suite;
  for (const bool timed : {false, true}) {
    for (const std::string_view name : {"table1", "table2", "table3"})
      for (std::string& scene : scenes_of_suite(name, timed)) in_tables.insert(std::move(scene));
    for (std::string& scene : scenes_of_suite("tables", timed)) in_suite.insert(std::move(scene));
  }
  EXPECT_EQ(in_suite, in_tables);
  EXPECT_EQ(backends_of("tables"), backends_of("table1"));
  EXPECT_EQ(backends_of(""), backends_of("table1"));
}

TEST(Suites, OfClustersMeasureRanksInPowersOfTwoAndWideClothsWithOneNumberOfThem) {
  const Comparison& cluster = comparison_of_suite("cluster");
  EXPECT_THAT(backends_of("cluster"), testing::ElementsAre("serial", "openmp"));
  EXPECT_THAT(cluster.programs({.threads = 1, .ranks = 6}),
              testing::ElementsAre("mpi:1", "mpi:2", "mpi:4", "mpi:6", "mpi-copies:2", "mpi-copies:4",
                                   "mpi-copies:6"));
  EXPECT_THAT(cluster.programs({.threads = 1, .ranks = 1}), testing::ElementsAre("mpi:1"));
  EXPECT_GE(cluster.programs({.threads = 1}).size(), 5U) << "one, two and four at least";
  for (const std::string_view backend : {"serial", "mpi:1", "mpi:4", "mpi-copies:2"})
    EXPECT_TRUE(cluster.is_compared("cloth350k", backend)) << backend;
  EXPECT_TRUE(cluster.is_compared("cloth10k-x4", "mpi:4"));
  for (const std::string_view backend : {"serial", "mpi:1", "mpi:2", "mpi-copies:4", "openmp"})
    EXPECT_FALSE(cluster.is_compared("cloth10k-x4", backend)) << backend;
  for (const Suite& suite : suites())
    EXPECT_EQ(suite.comparison.is_compared == nullptr, suite.name != "cluster") << suite.name;
}

}  // namespace
}  // namespace mssim
