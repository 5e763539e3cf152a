#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "model/data_folder.h"
#include "output/benchmark_json.h"
#include "output/csv.h"
#include "output/paper_table.h"
#include "output/published.h"
#include "output/result_folder.h"
#include "output/timings_csv.h"
#include "output/write_error.h"
#include "temporary_folder.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ResultFiles : public TemporaryFolderTest {};

ResultRow measured_row(const std::string& backend, double ms, std::optional<double> speedup) {
  ResultRow row;
  row.scene = "cloth2500";
  row.nodes = 2500;
  row.springs_unique = 14502;
  row.springs_published = 29004;
  row.backend = backend;
  row.device = "cpu";
  row.threads = 2;
  row.integrator = "semi-euler";
  row.dt_s = 0.0005;
  row.rounds = 3;
  row.ms_per_step = ms;
  row.ms_per_step_low = ms / 2;
  row.ms_per_step_high = 2 * ms;
  row.ms_per_step_min = ms / 2;
  row.springs_per_second = 14502 / (ms * 1e-3);
  row.gigabytes_per_second = 1.5;
  row.roofline_fraction = 0.25;
  row.speedup_vs_serial = speedup;
  row.paper_ms = 19.475;
  row.position_error = 1e-5;
  row.energy_drift = -2e-7;
  row.verified = true;
  row.samples_ms = {2 * ms, ms / 2, ms};
  row.sample_steps = {10, 20, 30};
  return row;
}

ResultRow failed_row(const std::string& backend, const std::string& status) {
  ResultRow row = measured_row(backend, 1, std::nullopt);
  row.ms_per_step = row.ms_per_step_low = row.ms_per_step_high = row.ms_per_step_min = std::nullopt;
  row.springs_per_second = row.gigabytes_per_second = row.roofline_fraction = std::nullopt;
  row.paper_ms = row.position_error = row.energy_drift = std::nullopt;
  row.samples_ms.clear();
  row.sample_steps.clear();
  row.rounds = 0;
  row.verified = false;
  row.status = status;
  return row;
}

Provenance made_up_provenance() {
  Provenance provenance;
  provenance.build = {"0.1.0", "0123456789abcdef0123456789abcdef01234567", true, "GNU 12", "-O3", "Release"};
  provenance.machine.cpu_model = "A Processor";
  provenance.machine.logical_cpus = 2;
  provenance.machine.cpu_mhz = 2999.6;
  provenance.machine.caches = {{1, "Data", 49152, 2, 1}};
  provenance.machine.load_average = {0.5, 0.25, 0.125};
  provenance.threads = 2;
  provenance.command_line = {"mssim", "bench"};
  provenance.started_utc = "2026-01-31T12:00:00Z";
  return provenance;
}

const PaperLegend legend{{{"serial", "cpu-only"},
                          {"threads-mutex", "multi-thread-cpu"},
                          {"openmp", "multi-thread-cpu"},
                          {"opencl", "gpu"},
                          {"hybrid", "gpu+multi-thread-cpu"}},
                         {{"semi-euler", "semi-euler", 1}, {"rk4", "rk4", 4}, {"rk4-frozen", "rk4", 1}}};

TEST_F(ResultFiles, TimingsHaveTheDocumentedColumnsAndQuoteWhatNeedsIt) {
  const std::vector<ResultRow> rows{measured_row("serial", 0.125, 1.0),
                                    failed_row("opencl", "unavailable: no device \"fast, big\"\nhere")};
  EXPECT_EQ(
      timings_csv(rows),
      "scene,nodes,springs_unique,springs_published,backend,device,threads,integrator,dt_s,rounds,"
      "ms_per_step,ms_per_step_low,ms_per_step_high,ms_per_step_min,springs_per_second,"
      "gigabytes_per_second,roofline_fraction,speedup_vs_serial,paper_ms,position_error,energy_drift,"
      "verified,status\n"
      "cloth2500,2500,14502,29004,serial,cpu,2,semi-euler,5e-04,3,0.125,0.0625,0.25,0.0625,116016000,1.5,"
      "0.25,1,19.475,1e-05,-2e-07,true,ok\n"
      "cloth2500,2500,14502,29004,opencl,cpu,2,semi-euler,5e-04,0,,,,,,,,,,,,false,"
      "\"unavailable: no device \"\"fast, big\"\"\nhere\"\n");
}

TEST_F(ResultFiles, TimingsAndSamplesComeBackAsTheyWere) {
  std::vector<ResultRow> rows{measured_row("serial", 1.0 / 3, 1.0), measured_row("openmp", 0.1, M_PI),
                              failed_row("opencl", "failed: \"x\", at\r\nstep 3")};
  rows[1].samples_ms = {0.1, 1.0 / 7, std::numeric_limits<double>::denorm_min()};
  ResultFolder(folder(), made_up_provenance(), legend, published_table1()).write(rows);
  const std::vector<ResultRow> back = read_results(folder());
  ASSERT_EQ(back.size(), rows.size());
  EXPECT_EQ(timings_csv(back), timings_csv(rows));
  EXPECT_EQ(samples_csv(back), samples_csv(rows));
  EXPECT_EQ(back[0].ms_per_step, 1.0 / 3);
  EXPECT_EQ(back[1].speedup_vs_serial, M_PI);
  EXPECT_EQ(back[1].samples_ms, rows[1].samples_ms);
  EXPECT_EQ(back[1].sample_steps, rows[1].sample_steps);
  EXPECT_TRUE(back[1].verified);
  EXPECT_EQ(back[2].status, rows[2].status);
  EXPECT_EQ(back[2].ms_per_step, std::nullopt);
}

TEST_F(ResultFiles, SamplesAreListedRoundByRound) {
  EXPECT_EQ(samples_csv(std::vector{measured_row("serial", 0.5, 1.0)}),
            "scene,backend,integrator,round,steps,ms_per_step\n"
            "cloth2500,serial,semi-euler,1,10,1\n"
            "cloth2500,serial,semi-euler,2,20,0.25\n"
            "cloth2500,serial,semi-euler,3,30,0.5\n");
}

TEST_F(ResultFiles, TimingsAllowFurtherColumnsBehindTheirs) {
  std::istringstream lines(timings_csv(std::vector{measured_row("serial", 0.5, 1.0)}));
  std::string header, row;
  std::getline(lines, header);
  std::getline(lines, row);
  const auto back = read_timings(put("timings.csv", header + ",joules\r\n" + row + ",3\r\n"));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].status, "ok");
}

TEST_F(ResultFiles, ThatAreWrongAreRefusedWithThePlace) {
  const std::string good = timings_csv(std::vector{measured_row("serial", 0.5, 1.0)});
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      read_timings(put("timings.csv", text));
    } catch (const CsvError& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.rfind(from), from.size(), to);
  };
  EXPECT_EQ(complaint(good), "accepted");
  EXPECT_THAT(complaint(with("19.475", "fast")), HasSubstr("timings.csv, line 2, column paper_ms: \"fast\""));
  EXPECT_THAT(complaint(with("19.475", "nan")), HasSubstr("column paper_ms: \"nan\""));
  EXPECT_THAT(complaint(with("2500,14502", "-1,14502")), HasSubstr("column nodes: \"-1\""));
  EXPECT_THAT(complaint(with("true", "yes")), HasSubstr("column verified: \"yes\""));
  EXPECT_THAT(complaint(with(",ok", "")), HasSubstr("line 2: has 22 fields where the header has 23"));
  EXPECT_THAT(complaint(with("ok", "\"ok")), HasSubstr("line 2: a quoted field does not end"));
  EXPECT_THAT(complaint(with("roofline_fraction", "roof")), HasSubstr("column 17 is \"roof\""));
  EXPECT_THAT(complaint(""), HasSubstr("column 1 is missing"));
  EXPECT_THROW(read_timings(folder() / "missing.csv"), CsvError);
  EXPECT_THROW(read_timings(folder()), CsvError);
}

TEST_F(ResultFiles, SamplesOutOfOrderAreRefused) {
  std::vector<ResultRow> rows{measured_row("serial", 0.5, 1.0)};
  rows[0].samples_ms.clear();
  rows[0].sample_steps.clear();
  const fs::path file = put("samples.csv",
                            "scene,backend,integrator,round,steps,ms_per_step\n"
                            "cloth2500,serial,semi-euler,2,10,1\n");
  EXPECT_THROW(read_samples(file, rows), CsvError);
}

TEST(Published, TimesEqualTheDataFileEverywhere) {
  const PublishedTable table = published_table1();
  std::ifstream file(data_folder() / "published/hong2016_table1.csv");
  std::string line;
  std::getline(file, line);
  int times = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 5U);
    EXPECT_EQ(table.ms(fields[0], fields[1], std::stoull(fields[2]), std::stoull(fields[3])),
              std::stod(fields[4]))
        << line;
    ++times;
  }
  EXPECT_EQ(times, 3 * 3 * 6);
}

TEST(Published, TimesExistOnlyForWhatThePaperMeasured) {
  const PublishedTable table = published_table1();
  EXPECT_EQ(table.ms("rk4", "gpu+multi-thread-cpu", 2500, 29004), std::nullopt);
  EXPECT_EQ(table.ms("rk4-frozen", "gpu", 2500, 29004), std::nullopt);
  EXPECT_EQ(table.ms("rk4", "gpu", 2501, 29004), std::nullopt);
  EXPECT_EQ(table.ms("rk4", "gpu", 2500, 29000), std::nullopt);  // 2500 nodes, but another shape
  EXPECT_TRUE(table.has_scene(350000, 4188004));
  EXPECT_FALSE(table.has_scene(2500, 29000));
}

TEST(Published, TableOfBodiesReadsToo) {
  const PublishedTable table(data_folder() / "published/hong2016_table3.csv");
  EXPECT_EQ(table.ms("semi-euler", "gpu+multi-thread-cpu", 38233, 759330), 127.45);
}

std::vector<ResultRow> table_rows() {
  std::vector<ResultRow> rows{measured_row("serial", 0.1, 1.0), measured_row("openmp", 0.0125, 8.0),
                              measured_row("hybrid", 0.05, 2.0),
                              failed_row("opencl", "failed: step 3 | node 7 is not finite")};
  rows[2].device = "Some device";
  rows.push_back(measured_row("serial", 1.5, 1.0));
  rows.back().scene = "cloth350k";
  rows.back().nodes = 350000;
  rows.back().springs_published = 4188004;
  rows.push_back(measured_row("serial", 3, 1.0));
  rows.back().scene = "my-own";
  rows.back().nodes = 2501;
  return rows;
}

TEST(PaperTable, AsCsvHasPublishedAndMeasuredUnderOneAnother) {
  const PaperTable table = paper_table1(table_rows(), legend, published_table1(), made_up_provenance());
  EXPECT_FALSE(table.empty);
  EXPECT_EQ(table.csv,
            "integrator,configuration,backend,quantity,cloth2500,cloth350k\n"
            ",,,nodes,2500,350000\n"
            ",,,springs_published,29004,4188004\n"
            "semi-euler,cpu-only,serial,published_ms,19.475,2733.484\n"
            "semi-euler,cpu-only,serial,measured_ms,0.1,1.5\n"
            "semi-euler,cpu-only,serial,published_speedup,1,1\n"
            "semi-euler,cpu-only,serial,measured_speedup,1,1\n"
            "semi-euler,cpu-only,serial,status,ok,ok\n"
            "semi-euler,multi-thread-cpu,openmp,published_ms,6.6,586.35\n"
            "semi-euler,multi-thread-cpu,openmp,measured_ms,0.0125,\n"
            "semi-euler,multi-thread-cpu,openmp,published_speedup," +
                csv_number(19.475 / 6.6) + "," + csv_number(2733.484 / 586.35) +
                "\n"
                "semi-euler,multi-thread-cpu,openmp,measured_speedup,8,\n"
                "semi-euler,multi-thread-cpu,openmp,status,ok,\n"
                "semi-euler,gpu,opencl,published_ms,1.827,115.015\n"
                "semi-euler,gpu,opencl,measured_ms,,\n"
                "semi-euler,gpu,opencl,published_speedup," +
                csv_number(19.475 / 1.827) + "," + csv_number(2733.484 / 115.015) +
                "\n"
                "semi-euler,gpu,opencl,measured_speedup,,\n"
                "semi-euler,gpu,opencl,status,failed: step 3 | node 7 is not finite,\n"
                "semi-euler,gpu+multi-thread-cpu,hybrid,published_ms,,\n"
                "semi-euler,gpu+multi-thread-cpu,hybrid,measured_ms,0.05,\n"
                "semi-euler,gpu+multi-thread-cpu,hybrid,published_speedup,,\n"
                "semi-euler,gpu+multi-thread-cpu,hybrid,measured_speedup,2,\n"
                "semi-euler,gpu+multi-thread-cpu,hybrid,status,ok,\n");
}

TEST(PaperTable, AsMarkdownTellsPublishedFromMeasured) {
  const std::string text =
      paper_table1(table_rows(), legend, published_table1(), made_up_provenance()).markdown;
  EXPECT_THAT(text,
              HasSubstr("Measured on A Processor (2 logical CPUs) with 2 threads; device Some device; mssim "
                        "0.1.0, commit 0123456789ab with uncommitted changes; 2026-01-31T12:00:00Z."));
  EXPECT_THAT(text, HasSubstr("## semi-euler: 1 force evaluation a step, beside the published semi-euler\n"
                              "\n"
                              "| nodes<br>springs | 2,500<br>29,004 | 350,000<br>4,188,004 |\n"
                              "|---|---:|---:|\n"
                              "| CPU only, *published* | 19.475 | 2733.484 |\n"
                              "| `serial`, **measured** | **0.100** | **1.50** |\n"
                              "| Multi-thread CPU, *published* | 6.6 (2.95×) | 586.35 (4.66×) |\n"
                              "| `openmp`, **measured** | **0.0125** (8.00×) | – |\n"
                              "| GPU, *published* | 1.827 (10.7×) | 115.015 (23.8×) |\n"
                              "| `opencl`, **measured** | failed | – |\n"
                              "| GPU + multi-thread CPU, *not published* | – | – |\n"
                              "| `hybrid`, **measured** | **0.0500** (2.00×) | – |\n"));
  EXPECT_THAT(text,
              HasSubstr("- `cloth2500`, `opencl`, `semi-euler`: failed: step 3 \\| node 7 is not finite\n"));
  EXPECT_THAT(text, HasSubstr("Inferred from those times, not stated in the paper"));
  EXPECT_THAT(text, Not(HasSubstr("my-own")));
}

TEST(PaperTable, ShowsNoTimeThatWasNotVerified) {
  std::vector<ResultRow> rows{measured_row("openmp", 0.0125, 8.0)};
  rows[0].verified = false;
  const PaperTable table = paper_table1(rows, legend, published_table1(), made_up_provenance());
  EXPECT_THAT(table.markdown, HasSubstr("| `openmp`, **measured** | failed |"));
  EXPECT_THAT(table.csv, Not(HasSubstr("0.0125")));
}

TEST(PaperTable, ComparesFrozenIntegratorsWithThePublishedMethod) {
  std::vector<ResultRow> rows{measured_row("openmp", 0.0125, 8.0)};
  rows[0].integrator = "rk4-frozen";
  const PaperTable table = paper_table1(rows, legend, published_table1(), made_up_provenance());
  EXPECT_THAT(table.csv, HasSubstr("rk4-frozen,multi-thread-cpu,openmp,published_ms,7.94\n"));
  EXPECT_THAT(table.markdown,
              HasSubstr("## rk4-frozen: 1 force evaluation a step, beside the published rk4\n"));
  EXPECT_THAT(table.markdown, Not(HasSubstr("--integrator all")));
  rows[0].integrator = "rk4";
  const std::string real = paper_table1(rows, legend, published_table1(), made_up_provenance()).markdown;
  EXPECT_THAT(real, HasSubstr("## rk4: 4 force evaluations a step, beside the published rk4\n"));
  EXPECT_THAT(real, HasSubstr("--integrator all"));
}

TEST(PaperTable, OfOtherScenesIsEmpty) {
  std::vector<ResultRow> rows{measured_row("serial", 1, 1.0)};
  rows[0].springs_published = 29000;
  EXPECT_TRUE(paper_table1(rows, legend, published_table1(), made_up_provenance()).empty);
}

TEST(BenchmarkJson, HasTheSchemaOfGoogleBenchmark) {
  const auto json = benchmark_json(
      std::vector{failed_row("opencl", "failed: x"), measured_row("serial", 0.5, 1.0)}, made_up_provenance());
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
  EXPECT_EQ(benchmark_json(rows, made_up_provenance())["benchmarks"].size(), 1U);
}

TEST_F(ResultFiles, AreAllThereAfterEveryWriteAndJsonIsValid) {
  const ResultFolder results(folder() / "new/out", made_up_provenance(), legend, published_table1());
  EXPECT_EQ(nlohmann::json::parse(text_of(folder() / "new/out/provenance.json")),
            to_json(made_up_provenance()));
  EXPECT_TRUE(read_results(folder() / "new/out").empty());
  std::vector<ResultRow> rows;
  for (const ResultRow& row : table_rows()) {
    rows.push_back(row);
    results.write(rows);
    EXPECT_EQ(text_of(folder() / "new/out/timings.csv"), timings_csv(rows));
    EXPECT_EQ(text_of(folder() / "new/out/samples.csv"), samples_csv(rows));
    EXPECT_EQ(nlohmann::ordered_json::parse(text_of(folder() / "new/out/benchmark.json")),
              benchmark_json(rows, made_up_provenance()));
    const PaperTable table = paper_table1(rows, legend, published_table1(), made_up_provenance());
    EXPECT_EQ(text_of(folder() / "new/out/table1.csv"), table.csv);
    EXPECT_EQ(text_of(folder() / "new/out/table1.md"), table.markdown);
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder() / "new/out"))
    names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, testing::UnorderedElementsAre("timings.csv", "samples.csv", "benchmark.json",
                                                   "provenance.json", "table1.csv", "table1.md"));
}

TEST_F(ResultFiles, StayAsTheyWereWhenANumberIsNotFinite) {
  const ResultFolder results(folder(), made_up_provenance(), legend, published_table1());
  std::vector<ResultRow> rows{measured_row("serial", 0.5, 1.0)};
  results.write(rows);
  const std::string before = text_of(folder() / "timings.csv") + text_of(folder() / "benchmark.json");
  rows.push_back(measured_row("openmp", 0.25, 2.0));
  rows[1].energy_drift = std::numeric_limits<double>::infinity();
  EXPECT_THROW(results.write(rows), std::invalid_argument);
  rows[1].energy_drift = 0;
  rows[1].samples_ms[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(results.write(rows), std::invalid_argument);
  EXPECT_EQ(text_of(folder() / "timings.csv") + text_of(folder() / "benchmark.json"), before);
}

TEST_F(ResultFiles, CannotGoWhereAFileIs) {
  put("taken", "a file");
  EXPECT_THROW(ResultFolder(folder() / "taken", made_up_provenance(), legend, published_table1()),
               WriteError);
  EXPECT_EQ(text_of(folder() / "taken"), "a file");
}

}  // namespace
}  // namespace mssim
