#include "application/bench/bench_plan.h"

#include <nlohmann/json.hpp>

#include "application/bench/suites.h"
#include "bench/results/result.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

class BenchPlanTest : public TemporaryFolderTest {
 protected:
  BenchPlanTest() {
    options_.scenes = {file_.string()};
    options_.backends = {"serial"};
    options_.integrators = {"semi-euler"};
    options_.execution.threads = 1;
    options_.rounds = 1;
  }

  void expect_refused(const std::vector<std::string>& wrong_backends) {
    for (const std::string& wrong : wrong_backends) {
      options_.backends = {wrong};
      EXPECT_THROW(plan_of(options_), UsageError) << wrong;
    }
  }

  std::string text_ = read_file(source_file("scenes/cloth2500.json"));
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

TEST_F(BenchPlanTest, RefusesFramesOfMoreStepsThanCanBeCounted) {
  options_.output.folder = "out";
  options_.fps = 1e-5;  // 2e9 steps of 5e-5 s
  const std::string sentence = sentence_of<UsageError>([&] { plan_of(options_); });
  for (const char* part : {"--fps 1e-05", "1,000,000,000 steps of 5e-05 s", "mine", "give more"})
    EXPECT_THAT(sentence, HasSubstr(part));
  options_.fps = 1e-4;
  EXPECT_EQ(plan_of(options_).timed.front().size.frame_steps, 200'000'000);
}

TEST_F(BenchPlanTest, RefusesFramesThatNoFolderKeepsOrThatAreShorterThanAStep) {
  options_.fps = 60;
  const auto refusal = [&] { return sentence_of<UsageError>([&] { plan_of(options_); }); };
  EXPECT_THAT(refusal(), HasSubstr("give --out"));
  options_.dry_run = true;
  plan_of(options_);
  options_.fps = 20001;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("--fps 20001"), HasSubstr("5e-05 s on mine"),
                               HasSubstr("give a smaller number")));
}

TEST_F(BenchPlanTest, ExpectsTheFramesOfAScenesAutomaticStep) {
  options_.output.folder = "out";
  options_.fps = 60;
  for (const char* shipped : {"scenes/cloth2500.json", "scenes/box-small.json"}) {
    nlohmann::json scene = nlohmann::json::parse(read_file(source_file(shipped)));
    scene["dt_s"] = "auto";
    const auto file = put("auto.json", scene.dump());
    options_.scenes = {file.string()};
    const int steps = steps_of_frame(60, prepare_scene(load_scene(file)).dt_s);
    EXPECT_GT(steps, 1);
    EXPECT_EQ(plan_of(options_).timed.front().size.frame_steps, steps) << shipped;
  }
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
  return mapped<std::string_view>(backends, &BackendInfo::name);
}

TEST_F(BenchPlanTest, HasARowForEachNumberOfThreadsButOfABackendOfOneThread) {
  options_.backends = {"serial", "openmp", "threads-mutex"};
  options_.threads = {2, 1};
  options_.execution.threads = 2;
  BenchPlan plan = plan_of(options_);
  EXPECT_THAT(names_in(plan.timed.front().backends),
              ElementsAre("serial", "threads-mutex:1", "threads-mutex", "openmp:1", "openmp"));
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
  EXPECT_THAT(names_in(plan_of(options_).settings.backends),
              testing::UnorderedElementsAre("openmp:1", "openmp"));
}

TEST_F(BenchPlanTest, TakesABackendOnItsOwnNumberOfThreads) {
  options_.backends = {"openmp:2", "openmp"};
  EXPECT_THAT(names_in(plan_of(options_).settings.backends), ElementsAre("openmp", "openmp:2"));
  expect_refused({"serial:2", "openmp:0", "openmp:x", "openmp:4000"});
}

TEST_F(BenchPlanTest, HasARowForEachInstructionSetThatIsAskedFor) {
  const std::vector<std::string_view> sets = instruction_sets();  // the best first
  if (sets.size() < 2) GTEST_SKIP() << "this CPU has vector code for one instruction set only";
  const std::string best(instruction_set_name(sets[0])), other(instruction_set_name(sets.back()));
  options_.backends = {"serial", "openmp"};
  options_.instruction_sets = {other, best, other};
  options_.threads = {1, 2};
  options_.execution.threads = 2;
  BenchPlan plan = plan_of(options_);
  EXPECT_THAT(names_in(plan.settings.backends),
              ElementsAre("serial", "openmp:" + other + ":1", "openmp:" + other, "openmp:1", "openmp"));
  const System system = plan.timed.front().prepare().system;
  for (const BackendInfo* backend : plan.settings.backends) {
    if (!backend->has_vectors) continue;
    const auto made =
        make_backend(*backend, system, *find_integrator("semi-euler"), 1e-4, plan.settings.execution);
    const bool is_other = backend->name.starts_with("openmp:" + other);
    EXPECT_EQ(made->device(), "cpu " + std::string(is_other ? sets.back() : sets[0])) << backend->name;
    EXPECT_EQ(made->threads(), backend->name.ends_with(":1") ? 1 : 2) << backend->name;
  }

  options_.threads = {};
  options_.backends = {"openmp", "openmp:" + other};
  EXPECT_THAT(names_in(plan_of(options_).settings.backends),
              testing::UnorderedElementsAre("openmp", "openmp:" + other));

  options_.instruction_sets = {other};
  options_.backends = {"openmp", "openmp:" + best};
  plan = plan_of(options_);
  EXPECT_THAT(names_in(plan.settings.backends), ElementsAre("openmp", "openmp:" + best));
  EXPECT_EQ(plan.settings.execution.instruction_set, sets.back());
  EXPECT_EQ(execution_of(*plan.settings.backends[1], plan.settings.execution).instruction_set, sets[0]);

  expect_refused({"serial:" + best, "openmp:" + best + ":" + other, "openmp:1:" + best});
  options_.backends = {"openmp"};
  options_.instruction_sets = {"parallel"};
  EXPECT_THAT([&] { plan_of(options_); }, testing::ThrowsMessage<UsageError>(HasSubstr(best)));
}

TEST_F(BenchPlanTest, TakesTheBaselineInDoublePrecision) {
  options_.backends = {"serial", "serial:double"};
  options_.integrators = {"semi-euler", "rk4", "verlet"};
  BenchPlan plan = plan_of(options_);
  ASSERT_THAT(names_in(plan.settings.backends), ElementsAre("serial", "serial:double"));
  const BackendInfo &single = *plan.settings.backends[0], &twice = *plan.settings.backends[1];
  EXPECT_NE(twice.role, BackendRole::baseline);
  const System system = plan.timed.front().prepare().system;
  const auto end_of = [](Backend& backend) {
    backend.step(20);
    return state_hash(backend.state());
  };
  for (const Integrator* integrator : plan.settings.integrators) {
    EXPECT_GT(memory_of(twice, *integrator, true).bytes(*integrator, 1000, 6000, 1),
              memory_of(single, *integrator, true).bytes(*integrator, 1000, 6000, 1));
    const auto backend = make_backend(twice, system, *integrator, 1e-4, {});
    EXPECT_EQ(end_of(*backend), end_of(*make_reference(system, *integrator, 1e-4))) << integrator->name;
  }
  EXPECT_THROW(make_backend(twice, system, *find_integrator("implicit-euler"), 1e-4, {}), Unsupported);
  expect_refused({"hybrid:double", "serial:double:double", "serial:double:2", "openmp:2:double"});
}

TEST_F(BenchPlanTest, TakesOpenMpInDoublePrecisionWithThreadsAndInstructionSets) {
  const std::string least(instruction_sets().back());
  options_.backends = {"openmp", "openmp:double", "openmp:double:1", "openmp:double:" + least};
  options_.execution.threads = 2;
  const BenchPlan plan = plan_of(options_);
  ASSERT_THAT(names_in(plan.settings.backends),
              ElementsAre("openmp", "openmp:double", "openmp:double:1", "openmp:double:" + least));
  EXPECT_EQ(std::ranges::count(plan.settings.backends, true, &BackendInfo::in_double), 3);
  EXPECT_GT(plan.settings.backends[1]->step_share, plan.settings.backends[0]->step_share);
  EXPECT_EQ(plan.settings.backends[2]->threads, 1);
  EXPECT_EQ(plan.settings.backends[3]->instruction_set, least);
}

TEST_F(BenchPlanTest, TakesABackendThatStepsEachBodyForItself) {
  options_.scenes = {"bodies3858"};
  options_.backends = {"openmp:each:2"};
  EXPECT_THAT(names_in(plan_of(options_).settings.backends), ElementsAre("openmp:each:2"));
  options_.backends = {"openmp:each:2", "serial", "serial:each", "openmp:each"};
  options_.threads = {1, 2};
  options_.execution.threads = 2;
  const BenchPlan plan = plan_of(options_);
  EXPECT_THAT(names_in(plan.settings.backends),
              testing::UnorderedElementsAre("serial", "serial:each", "openmp:each:1", "openmp:each:2",
                                            "openmp:each"));
  for (const BackendInfo* backend : plan.settings.backends) {
    EXPECT_EQ(backend->each_body, backend->name != "serial") << backend->name;
    EXPECT_EQ(backend->role == BackendRole::baseline, backend->name == "serial") << backend->name;
    EXPECT_EQ(execution_of(*backend, plan.settings.execution).threads, backend->name.ends_with(":1") ? 1 : 2);
  }
  expect_refused(
      {"serial:each:2", "openmp:2:each", "openmp:each:each", "openmp:each:0", "mpi:each", "openmp:eac"});
}

/// The plan of a suite, where no user names backends or threads.
BenchPlan plan_of_suite(std::string suite, const std::vector<std::string>& scenes = {}) {
  BenchOptions options;
  options.suite = std::move(suite);
  options.scenes = scenes;
  options.dry_run = true;
  return plan_of(options);
}

TEST(Suites, HaveTheirVariantsOnTheirOwnScenesWhereNobodyNamesBackendsOrThreads) {
  EXPECT_THAT(variants_of_suite("table1", "cloth2500"), ElementsAre("threads-mutex:10"));
  EXPECT_THAT(variants_of_suite("table3", "bodies3858"),
              testing::IsSupersetOf({"serial:each", "threads-mutex:10", "threads-mutex:each",
                                     "threads-mutex:each:10", "hybrid:each"}));
  EXPECT_TRUE(variants_of_suite("", "cloth2500").empty());
  for (const Suite& suite : suites()) {
    if (!suite.timed || suite.name == guide_suite || suite.comparison.described_too) continue;
    const BenchPlan plan = plan_of_suite(std::string(suite.name));  // which holds its rows
    for (const PlannedScene& scene : plan.timed) {
      std::vector<std::string_view> names = names_in(scene.backends);
      for (const std::string_view variant : suite.variants)
        EXPECT_EQ(std::erase(names, variant), 1U) << suite.name << ", " << scene.spec.name;
      EXPECT_TRUE(std::ranges::none_of(names, [](std::string_view name) { return name.ends_with(":each"); }))
          << suite.name;
    }
  }
  const BenchPlan tables = plan_of_suite("tables", {"cloth1m", "sphere-small"});
  for (const PlannedScene& scene : tables.timed) {
    const auto has = [&](std::string_view name) {
      return std::ranges::find(scene.backends, name, &BackendInfo::name) != scene.backends.end();
    };
    const bool in_suite = scene.spec.name != "cloth1m" && scene.spec.name != "sphere-small";
    EXPECT_EQ(has("threads-mutex:10"), in_suite) << scene.spec.name;
    EXPECT_EQ(has("hybrid:each"), in_suite && scene.spec.name.starts_with("bodies")) << scene.spec.name;
  }
  BenchOptions options;
  options.suite = "table3";
  options.dry_run = true;
  options.execution.threads = 1;
  const BenchPlan on_one = plan_of(options);
  EXPECT_THAT(names_in(on_one.timed.front().backends), Not(Contains("threads-mutex:10")));
  options.execution.threads = 0;
  options.backends = {"hybrid:each"};
  const BenchPlan named = plan_of(options);
  EXPECT_THAT(names_in(named.timed.front().backends), ElementsAre("hybrid:each"));
}

TEST(Suites, HaveVariantsOfBackendsThatThePaperHas) {
  for (const Suite& suite : suites())
    for (const std::string_view variant : suite.variants)
      EXPECT_EQ(std::ranges::count_if(backends(),
                                      [&](const BackendInfo& backend) {
                                        return is_variant(variant, backend.name) &&
                                               !backend.paper_configuration.empty();
                                      }),
                1)
          << suite.name << ": " << variant;
  const PaperLegend legend = paper_legend();
  const auto configuration = [&](std::string_view name) {
    return std::ranges::find(legend.backends, name, &PaperLegend::Backend::name)->configuration;
  };
  EXPECT_EQ(configuration("threads-mutex:10"), configuration("threads-mutex"));
  EXPECT_EQ(configuration("hybrid:each"), configuration("hybrid"));
}

std::vector<std::string_view> backends_of(std::string_view suite) {
  return names_in(comparison_of_suite(suite).backends());
}

TEST(Suites, NameScenesAndIntegratorsThatExist) {
  for (const Suite& suite : suites()) {
    for (const std::string_view scene : suite.scenes)
      EXPECT_TRUE(is_scene(scene)) << suite.name << ": " << scene;
    EXPECT_NO_THROW(chosen_integrators({}, suite.comparison.integrators)) << suite.name;
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
  EXPECT_THAT(backends_of("cluster"), ElementsAre("serial", "openmp"));
  EXPECT_THAT(
      cluster.programs({.threads = 1, .ranks = 6}),
      ElementsAre("mpi:1", "mpi:2", "mpi:4", "mpi:6", "mpi-copies:2", "mpi-copies:4", "mpi-copies:6"));
  EXPECT_THAT(cluster.programs({.threads = 1, .ranks = 1}), ElementsAre("mpi:1"));
  EXPECT_GE(cluster.programs({.threads = 1}).size(), 5U) << "one, two and four at least";
  for (const std::string_view backend : {"serial", "mpi:1", "mpi:4", "mpi-copies:2"})
    EXPECT_TRUE(cluster.is_compared("cloth350k", backend)) << backend;
  EXPECT_TRUE(cluster.is_compared("cloth10k-x4", "mpi:4"));
  for (const std::string_view backend : {"serial", "mpi:1", "mpi:2", "mpi-copies:4", "openmp"})
    EXPECT_FALSE(cluster.is_compared("cloth10k-x4", backend)) << backend;
}

TEST(Suites, LeaveAlgorithm1AsPrintedOutOnTheFinestJeans) {
  const Comparison& garment = comparison_of_suite("garment");
  for (const BackendInfo& backend : garment_backends()) {
    EXPECT_TRUE(garment.is_compared("jeans16k", backend.name)) << backend.name;
    EXPECT_FALSE(garment.is_compared("jeans64k", backend.name)) << backend.name;
  }
  for (const BackendInfo& backend : backends())
    EXPECT_TRUE(garment.is_compared("jeans64k", backend.name)) << backend.name;
}

}  // namespace
}  // namespace mssim
