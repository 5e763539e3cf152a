#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "output/tables/results.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

using testing::ElementsAre;

TEST(BenchmarkJson, HasTheSchemaOfGoogleBenchmark) {
  const auto json = nlohmann::json::parse(
      benchmark_json(std::vector{failed_row("opencl", "failed: x"), measured_row("serial", 0.5, 1.0)},
                     made_up_provenance()));
  const auto& context = json["context"];
  EXPECT_EQ(context["json_schema_version"], 1);
  EXPECT_EQ(context["date"], "2026-01-31T12:00:00+00:00");
  EXPECT_EQ(context["host_name"], "");
  EXPECT_EQ(context["executable"], "mssim");
  EXPECT_EQ(context["num_cpus"], 2);
  EXPECT_EQ(context["mhz_per_cpu"], 3000);
  EXPECT_EQ(context["cpu_scaling_enabled"], false);
  EXPECT_EQ(context["caches"][0]["size"], 49152);
  EXPECT_THAT(context["load_avg"], ElementsAre(0.5, 0.25, 0.125));
  EXPECT_EQ(context["library_build_type"], "release");
  const auto& benchmarks = json["benchmarks"];
  ASSERT_EQ(benchmarks.size(), 3U + 4U);
  EXPECT_EQ(benchmarks[1]["name"], "cloth2500/serial/semi-euler");
  EXPECT_EQ(benchmarks[1]["run_type"], "iteration");
  EXPECT_EQ(benchmarks[1]["repetitions"], 3);
  EXPECT_EQ(benchmarks[1]["repetition_index"], 1);
  EXPECT_EQ(benchmarks[1]["iterations"], 20);
  EXPECT_EQ(benchmarks[1]["threads"], 2);
  EXPECT_EQ(benchmarks[1]["real_time"], 0.25e6);
  EXPECT_EQ(benchmarks[1]["cpu_time"], 0.25e6);
  EXPECT_EQ(benchmarks[1]["time_unit"], "ns");
  std::map<std::string, double> aggregates;
  for (std::size_t i = 3; i < benchmarks.size(); ++i) {
    EXPECT_EQ(benchmarks[i]["run_type"], "aggregate");
    EXPECT_EQ(benchmarks[i]["run_name"], "cloth2500/serial/semi-euler");
    const std::string name = benchmarks[i]["aggregate_name"];
    EXPECT_EQ(benchmarks[i]["name"], "cloth2500/serial/semi-euler_" + name);
    aggregates[name] = benchmarks[i]["real_time"];
  }
  // Of the samples 1, 0.25 and 0.5 ms.
  EXPECT_EQ(aggregates.size(), 4U);
  EXPECT_DOUBLE_EQ(aggregates["mean"], 1.75e6 / 3);
  EXPECT_DOUBLE_EQ(aggregates["median"], 0.5e6);
  EXPECT_NEAR(aggregates["stddev"], 0.38188131e6, 1e-2);
  EXPECT_NEAR(aggregates["cv"], 0.38188131 / (1.75 / 3), 1e-8);
}

TEST(BenchmarkJson, OfOneSampleHasNoAggregates) {
  std::vector<ResultRow> rows{measured_row("serial", 0.5, 1.0)};
  rows[0].samples_ms = {0.5};
  rows[0].sample_steps = {7};
  EXPECT_EQ(nlohmann::json::parse(benchmark_json(rows, made_up_provenance()))["benchmarks"].size(), 1U);
}

}  // namespace
}  // namespace mssim
