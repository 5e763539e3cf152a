#include "output/tables/results.h"

#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/files_fixture.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

using testing::ContainsRegex;

TEST(BenchmarkJson, HasTheSchemaOfGoogleBenchmark) {
  const auto json = nlohmann::json::parse(
      benchmark_json(std::vector{failed_row("opencl", "failed: x"), measured_row("serial", 0.5, 1.0)},
                     made_up_provenance()));
  const auto& context = json["context"];
  EXPECT_EQ(context["json_schema_version"], 1);
  EXPECT_EQ(context["date"], "2026-01-31T12:00:00+00:00");
  EXPECT_EQ(context["num_cpus"], 2);
  EXPECT_EQ(context["mhz_per_cpu"], 3000);
  EXPECT_EQ(context["cpu_scaling_enabled"], false);
  EXPECT_EQ(context["caches"][0]["size"], 49152);
  EXPECT_THAT(context["load_avg"], ElementsAre(0.5, 0.25, 0.125));
  const auto& benchmarks = json["benchmarks"];
  ASSERT_EQ(benchmarks.size(), 3U + 4U);
  EXPECT_EQ(benchmarks[1]["name"], "cloth2500/serial/semi-euler");
  EXPECT_EQ(benchmarks[1]["repetitions"], 3);
  EXPECT_EQ(benchmarks[1]["repetition_index"], 1);
  EXPECT_EQ(benchmarks[1]["iterations"], 20);
  EXPECT_EQ(benchmarks[1]["threads"], 2);
  EXPECT_EQ(benchmarks[1]["real_time"], 0.25e6);
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

using CombinationTimes = TemporaryFolderTest;

TEST_F(CombinationTimes, AreFoundWhateverElseAVersionWritesAndInWhichOrder) {
  const auto times = read_combination_times(
      put("timings.csv",
          "new,status,verified,ms_per_step_min,integrator,backend,scene\n7,ok,true,1.5,rk4,hybrid,mine\n"));
  ASSERT_EQ(times.size(), 1U);
  EXPECT_EQ(times[0].scene, "mine");
  EXPECT_EQ(times[0].least_ms, 1.5);
}

TEST_F(CombinationTimes, AreRefusedWhereOneIsMissingOrNoTime) {
  const std::string header = "scene,backend,integrator,ms_per_step_min,verified,status\n";
  const auto refusal = [&](const std::string& text) {
    return sentence_of<CsvError>([&] { read_combination_times(put("timings.csv", text)); });
  };
  EXPECT_THAT(refusal("scene,backend\n"), HasSubstr("there is no column integrator"));
  EXPECT_THAT(refusal(header + "a,b,c,0,true,ok\n"), HasSubstr("\"0\" is not between 1e-12 and 1e12"));
  EXPECT_THAT(refusal(header + "a,b,c,1e299,true,ok\n"), HasSubstr("\"1e299\" is not between"));
  EXPECT_THAT(refusal(header + "a,b,c,nan,true,ok\n"), HasSubstr("\"nan\" is not a number"));
  EXPECT_THAT(refusal(header + "a,b,c,1e301,true,ok\n"), HasSubstr("\"1e301\" is not a number"));
  EXPECT_THAT(refusal(header + "a,b,c,,true,ok\n"), HasSubstr("ms_per_step"));
  EXPECT_EQ(refusal(header + "a,b,c,,false,failed: x\n"), "");
}

TEST(GithubTable, KeepsTheDevicesOwnName) {
  ResultRow row = measured_row("opencl", 0.5, 1.0);
  row.device = "pthread-znver4-A Processor";
  EXPECT_THAT(table_csv(github_table(std::vector{row})), HasSubstr(row.device));
}

TEST(GithubTable, HasNoRangeOfTooFewRounds) {
  const ResultRow row = measured_row("serial", 0.5, 1.0);
  EXPECT_THAT(table_csv(github_table(std::vector{in_six_rounds(row)})), HasSubstr(",0.5,0.25 to 1,"));
  EXPECT_THAT(table_csv(github_table(std::vector{row})), HasSubstr(",0.5,,"));
}

TEST(RatioMark, StandsWhereTheTimesNameTheOtherOneAsTheFaster) {
  EXPECT_EQ(mark_of_ratio(0.923, 1.54, 1.48), "†");
  EXPECT_EQ(mark_of_ratio(1.1, 1.48, 1.54), "†");
  EXPECT_EQ(mark_of_ratio(0.95, 1.48, 1.54), "");
}

TEST(RatioMark, StandsWhereTheTimesDifferFromTheRatioByMoreThanAQuarter) {
  EXPECT_EQ(mark_of_ratio(4, 4.99, 1), "");
  EXPECT_EQ(mark_of_ratio(4, 5.02, 1), "†");
  EXPECT_EQ(mark_of_ratio(5.02, 4, 1), "†");
  EXPECT_EQ(mark_of_ratio(0.899, 1.35, 2.19), "†");
}

TEST(RatioMark, JudgesWhatIsShown) {
  EXPECT_EQ(mark_of_ratio(0.998, 1.501, 1.5), "");   // 1.50 and 1.50
  EXPECT_EQ(mark_of_ratio(0.9999, 1.52, 1.51), "");  // 1.00
}

TEST(RatioMark, IsExplainedWhereACellHasIt) {
  Table table;
  table.add({{"ratio", 2.0}});
  EXPECT_EQ(legend_of_ratios({table}), "");
  EXPECT_EQ(legend_of_ratios(Document{Paragraph{"†"}, table}), "");
  table.rows[0][0].suffix = "†";
  EXPECT_TRUE(legend_of_ratios({table}).starts_with("† the two times shown contradict this ratio: "));
  EXPECT_EQ(legend_of_ratios({Heading{1, "Times"}, table}), legend_of_ratios({table}));
}

std::string table_of(const std::vector<ResultRow>& rows, const Terminal& terminal) {
  Provenance provenance;
  provenance.threads = 2;
  return row_table(pointers_to(rows), provenance, terminal);
}

std::size_t widest_line(const std::string& text) {
  std::istringstream lines(text);
  std::size_t widest = 0;
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, width_of(line));
  return widest;
}

TEST(RowTable, ShowsABlockForEachSceneWithBarsInOneScale) {
  const std::vector<ResultRow> all = table_rows();
  EXPECT_EQ(table_of({all.begin(), all.end() - 1}, {.width = 74, .utf8 = true}),
            "cloth2500: 2,500 nodes, 14,502 springs (29,004 as Hong et al. count)\n"
            "  integrator  backend  ms/step        interval  verified  speed-up\n"
            "  semi-euler  serial     0.100    0.0500–0.200  ✓         1.00×  █▏\n"
            "              openmp    0.0125  0.00625–0.0250  ✓         8.00×  █████████\n"
            "              hybrid    0.0500    0.0250–0.100  ✓         2.00×  ██▎\n"
            "              opencl                            ✗         failed\n"
            "  opencl: failed: step 3 | node 7 is not finite\n"
            "\n"
            "cloth350k: 350,000 nodes, 14,502 springs (4,188,004 as Hong et al. count)\n"
            "  integrator  backend  ms/step        interval  verified  speed-up\n"
            "  semi-euler  serial      1.50      0.750–3.00  ✓         1.00×  █▏\n");
}

TEST(RowTable, IsAsciiWithoutUtf8) {
  std::vector<ResultRow> rows = table_rows();
  rows[1].speedup_vs_serial = 30;  // which the times contradict
  const std::string text = table_of(rows, {.width = 80});
  for (const char character : text) ASSERT_LT(static_cast<unsigned char>(character), 0x80);
  EXPECT_THAT(text, HasSubstr("0.00625-0.0250  yes       30.0x(?)  ############"));
  EXPECT_THAT(text, HasSubstr("  NO        failed\n"));
}

TEST(RowTable, HasEveryColumnWhereNothingHasToFit) {
  const std::string text = table_of(table_rows(), {});
  for (const char* header : {"threads", "interval", "published", "roofline", "error", "verified", "speed-up"})
    EXPECT_THAT(text, HasSubstr(header));
  EXPECT_THAT(text, HasSubstr("  19.475    25.0 %  1.0e-05  yes"));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
}

TEST(RowTable, FitsTheTerminal) {
  for (const int width : {60, 66, 70, 80, 100, 120, 200}) {
    const std::string text = table_of(table_rows(), {.width = width, .utf8 = true});
    EXPECT_LE(widest_line(text), static_cast<std::size_t>(width)) << text;
    EXPECT_THAT(text, HasSubstr("8.00×")) << width;
    EXPECT_THAT(text, HasSubstr("✓")) << width;
  }
}

TEST(RowTable, ColoursSayNothingThatCharactersDoNot) {
  const std::string plain = table_of(table_rows(), {.width = 80, .rewrites = true, .utf8 = true});
  std::string coloured =
      table_of(table_rows(), {.width = 80, .rewrites = true, .colours = true, .utf8 = true});
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
  EXPECT_THAT(coloured, HasSubstr("\033[32m✓\033[0m"));
  EXPECT_THAT(coloured, HasSubstr("\033[31m✗\033[0m"));
  for (std::size_t at = coloured.find('\033'); at != std::string::npos; at = coloured.find('\033'))
    coloured.erase(at, coloured.find('m', at) + 1 - at);
  EXPECT_EQ(coloured, plain);
}

TEST(RowTable, MarksARowThatIsNotVerified) {
  std::vector<ResultRow> rows{measured_row("serial", 0.1, 1.0), measured_row("openmp", 0.0125, 8.0)};
  rows[1].verified = false;
  const std::string text = table_of(rows, {.width = 80, .utf8 = true});
  EXPECT_THAT(text, HasSubstr("  ✗         failed\n  openmp: failed: not verified\n"));
  EXPECT_THAT(text, Not(HasSubstr("8.00")));
}

TEST(RowTable, SaysWhyOnceForAllBackends) {
  const std::string reason = "unsupported: garments";
  const std::string text = table_of(
      {measured_row("serial", 1, 1.0), failed_row("hybrid", reason), failed_row("threads-mutex", reason)},
      {.width = 80, .utf8 = true});
  EXPECT_THAT(text, HasSubstr("  -         unsupported\n  hybrid, threads-mutex: unsupported: garments\n"));
}

TEST(RowTable, HasNoColumnOfWhatNoRowHas) {
  ResultRow row = measured_row("openmp", 1, std::nullopt);
  row.paper_ms = row.roofline_fraction = std::nullopt;
  const std::string text = table_of({row}, {});
  for (const char* header : {"  published", "roofline", "speed-up", "#"})
    EXPECT_THAT(text, Not(HasSubstr(header)));
}

TEST(RowTable, KeepsNumbersInLineBesideMarks) {
  std::vector<ResultRow> rows{measured_row("serial", 0.1, 1.0), measured_row("openmp", 0.0125, 30.0)};
  rows[1].threads = 4;
  const std::string text = table_of(rows, {.width = 80, .utf8 = true});
  EXPECT_THAT(text, HasSubstr("serial    0.100      "));
  EXPECT_THAT(text, HasSubstr("openmp   0.0125 (!)  "));
  EXPECT_THAT(text, HasSubstr(" 1.00×   "));
  EXPECT_THAT(text, HasSubstr("30.0×†  "));
  const std::string ascii = table_of(rows, {.width = 80});
  EXPECT_THAT(ascii, HasSubstr("30.0x(?)  "));
  EXPECT_TRUE(legend_of_ratios(ascii).starts_with("(?) the two times shown contradict"));
}

ComparedRow row_of(const std::string& backend, std::optional<double> new_ms,
                   std::optional<RatioEstimate> ratio, Verdict verdict) {
  return {{"cloth2500", backend, "semi-euler"}, 1, new_ms, ratio, verdict, {}, "", {0.75, 1, 1.25}, {}};
}

RunComparison made_up_comparison() {
  RunComparison comparison;
  comparison.rows = {row_of("openmp", 2, RatioEstimate{2, 1.75, 2.25, true, 1e-6}, Verdict::slower),
                     row_of("serial", 1, RatioEstimate{1, 0.99, 1.01, true, 1}, Verdict::same),
                     row_of("opencl", std::nullopt, std::nullopt, Verdict::lost),
                     row_of("hybrid", 1.01, RatioEstimate{1.01, 0.5, 2, true, 0.5}, Verdict::undecided)};
  comparison.rows[0].new_samples_ms = {2.5, 2, 1.5};
  comparison.rows[2].reason = "failed: a | b";
  comparison.rows[3].samples_needed = 40;
  comparison.means = {{"", 3, 1.25}, {"openmp", 1, 2}};
  return comparison;
}

TEST(ComparisonTable, HoldsEveryRowInEveryFormat) {
  const RunComparison comparison = made_up_comparison();
  const std::string table = to_text(comparison, ComparisonFormat::table);
  EXPECT_THAT(table, ContainsRegex("cloth2500  openmp   semi-euler +1 +2 +2 +1.75 +2.25 +1e-06  slower"));
  EXPECT_THAT(table, ContainsRegex("hybrid .*undecided  40 samples per side would decide"));
  EXPECT_THAT(table, ContainsRegex("\n\nbackend  rows  geometric_mean_ratio\nall +3 +1.25\nopenmp +1 +2\n$"));
  EXPECT_THAT(to_text(comparison, ComparisonFormat::markdown),
              AllOf(HasSubstr("| 1.00 | 2.00 | 2.00 | 1.75 to 2.25 | **slower** |\n"),
                    HasSubstr("| `opencl` | semi-euler | 1.00 | – | – | – | **lost**: failed: a \\| b |\n"),
                    HasSubstr("| undecided: 40 samples per side would decide |\n"),
                    HasSubstr("| all | 3 | 1.25 |\n| `openmp` | 1 | 2.00 |\n")));
  const nlohmann::json json = nlohmann::json::parse(to_text(comparison, ComparisonFormat::json));
  EXPECT_EQ(json["regression"], true);
  EXPECT_EQ(json["threshold"], comparison.threshold);
  ASSERT_EQ(json["rows"].size(), 4U);
  EXPECT_EQ(json["rows"][0]["ratio"], 2.0);
  EXPECT_EQ(json["rows"][0]["base_samples_ms"], (std::vector{0.75, 1.0, 1.25}));
  EXPECT_EQ(json["rows"][0]["new_samples_ms"], (std::vector{2.5, 2.0, 1.5}));
  EXPECT_EQ(json["rows"][2]["verdict"], "lost");
  EXPECT_EQ(json["rows"][2]["ratio"], nullptr);
  EXPECT_EQ(json["geometric_means"][0]["backend"], "all");
}

TEST(ComparisonTable, MarksARatioThatItsTimesContradict) {
  RunComparison comparison = made_up_comparison();
  for (const auto format : {ComparisonFormat::table, ComparisonFormat::markdown})
    EXPECT_THAT(to_text(comparison, format), Not(HasSubstr("†")));
  comparison.rows[0].new_ms = 0.98;
  EXPECT_THAT(to_text(comparison, ComparisonFormat::table), HasSubstr("\n† the two times shown contradict"));
  EXPECT_THAT(to_text(comparison, ComparisonFormat::table, false),
              AllOf(HasSubstr("\n(?) the two times shown contradict"), Not(HasSubstr("†"))));
  EXPECT_THAT(to_text(comparison, ComparisonFormat::markdown), HasSubstr("| 0.980 | 2.00† | 1.75 to 2.25 |"));
  EXPECT_THAT(to_text(comparison, ComparisonFormat::json), Not(HasSubstr("†")));
}

}  // namespace
}  // namespace mssim
