#include "application/bench/suites.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bench/results/result.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"

namespace mssim {
namespace {

std::vector<std::string_view> backends_of(std::string_view suite) {
  std::vector<std::string_view> names;
  for (const BackendInfo* backend : comparison_of_suite(suite).backends()) names.push_back(backend->name);
  return names;
}

TEST(Suites, NameScenesAndIntegratorsThatExist) {
  const std::vector<std::string> known = scene_names();
  for (const Suite& suite : suites()) {
    for (const std::string_view scene : suite.scenes)
      EXPECT_NE(std::ranges::find(known, scene), known.end()) << suite.name << ": " << scene;
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
  EXPECT_EQ(in_suite.size(), 21U);
  EXPECT_EQ(backends_of("tables"), backends_of("table1"));
  EXPECT_EQ(backends_of(""), backends_of("table1"));
}

TEST(Suites, OfRacesAndScalingMeasureOneMethodOfTheirOwn) {
  EXPECT_THAT(scenes_of_suite("races", true), testing::ElementsAre("cloth40k", "bodies20587"));
  EXPECT_THAT(backends_of("races"),
              testing::ElementsAre("serial", "mutex-per-group", "lock-per-node", "atomic", "thread-private",
                                   "colouring", "gather", "gather-vectors", "openmp"));
  EXPECT_EQ(scenes_of_suite("scaling", true).back(), "cloth16m");
  EXPECT_EQ(backends_of("scaling"), backends_of("table1"));
  for (const std::string_view suite : {"races", "scaling"})
    EXPECT_THAT(comparison_of_suite(suite).integrators, testing::ElementsAre("semi-euler"));
}

TEST(Suites, OfPeersMeasuresClothsAndBodiesWithWhatIsDescribed) {
  EXPECT_THAT(scenes_of_suite("peers", true),
              testing::ElementsAre("cloth2500", "cloth40k", "cloth350k", "bodies38233"));
  EXPECT_THAT(backends_of("peers"), testing::ElementsAre("serial", "openmp"));
  EXPECT_THAT(comparison_of_suite("peers").integrators, testing::ElementsAre("semi-euler"));
  for (const Suite& suite : suites()) EXPECT_EQ(suite.comparison.described_too, suite.name == "peers");
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

TEST(Suites, OfGarmentsAreTheJeansOfTheFigureWithTheOneMethodThatDresses) {
  EXPECT_THAT(scenes_of_suite("garment", true),
              testing::ElementsAre("jeans1k", "jeans2k", "jeans4k", "jeans8k", "jeans16k", "jeans64k"));
  EXPECT_THAT(comparison_of_suite("garment").integrators, testing::ElementsAre("semi-euler"));
  EXPECT_EQ(backends_of("garment"), backends_of("table1"));
}

}  // namespace
}  // namespace mssim
