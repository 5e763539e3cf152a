#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/report_internal.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

/// A row of a published cloth; in each round it takes the same time.
ResultRow cloth_row(std::uint64_t nodes, std::uint64_t springs_published, const std::string& backend,
                    double ms, const std::string& integrator = "semi-euler") {
  ResultRow row = measured_row(backend, ms, std::nullopt);
  row.scene = "cloth" + std::to_string(nodes);
  row.nodes = nodes;
  row.springs_published = springs_published;
  row.springs_unique = springs_published / 2;
  row.integrator = integrator;
  return row;
}
ResultRow small(const std::string& backend, double ms, const std::string& integrator = "semi-euler") {
  return cloth_row(2500, 29004, backend, ms, integrator);
}
ResultRow larger(const std::string& backend, double ms) { return cloth_row(4900, 57404, backend, ms); }

std::vector<Finding> about(std::vector<Finding> (*findings)(const PaperScenes&),
                           const std::vector<ResultRow>& rows) {
  const PublishedTable table1(published_table_kinds[0]);
  return findings(PaperScenes(rows, legend, table1));
}

/// The outcome of the one finding that holds a text.
Outcome outcome(const std::vector<Finding>& findings, const std::string& text) {
  const auto holds = [&](const Finding& finding) { return finding.sentence.find(text) != std::string::npos; };
  EXPECT_EQ(std::ranges::count_if(findings, holds), 1) << text;
  const auto found = std::ranges::find_if(findings, holds);
  return found == findings.end() ? Outcome::warning : found->outcome;
}

TEST(OrderFindings, SayWhetherThePublishedOrderIsReproduced) {
  const auto with = [](double ms) {
    return about(order_findings, {small("serial", 1), small("threads-mutex", ms)});
  };
  EXPECT_EQ(outcome(with(0.5), "`threads-mutex` is faster than `serial` in 1"), Outcome::reproduced);
  EXPECT_EQ(outcome(with(2), "`threads-mutex` is faster than `serial` in 0, slower in 1"),
            Outcome::not_reproduced);
  std::vector<ResultRow> rows{small("serial", 1), small("threads-mutex", 1)};
  rows[1].samples_ms = {3, 0.25, 1.1};
  EXPECT_EQ(outcome(about(order_findings, rows), "cannot be told apart in 1"), Outcome::undecided);
}

TEST(OrderFindings, NameASizeFromWhichOnABackendIsFasterAtEveryLargerOne) {
  constexpr double slower = 2, faster = 0.5, undecided = 1;
  const auto sentence = [&](double at_small, double at_larger, double at_largest) {
    std::vector<ResultRow> rows{small("serial", 1),
                                larger("serial", 1),
                                cloth_row(10000, 118004, "serial", 1),
                                small("opencl", at_small),
                                larger("opencl", at_larger),
                                cloth_row(10000, 118004, "opencl", at_largest)};
    for (ResultRow& row : rows)
      if (row.backend == "opencl" && row.ms_per_step == undecided) row.samples_ms = {3, 0.25, 1.1};
    return about(order_findings, rows).at(0).sentence;
  };
  using testing::HasSubstr;
  EXPECT_THAT(sentence(slower, faster, faster), HasSubstr("It becomes faster from 4,900 nodes"));
  EXPECT_THAT(sentence(slower, slower, faster), HasSubstr("It becomes faster from 10,000 nodes"));
  EXPECT_THAT(sentence(slower, undecided, faster), HasSubstr("It becomes faster from 10,000 nodes"));
  for (const std::string& none : {sentence(slower, faster, slower), sentence(slower, faster, undecided),
                                  sentence(faster, slower, faster), sentence(slower, slower, slower)})
    EXPECT_THAT(none, testing::Not(HasSubstr("becomes faster")));
}

TEST(OrderFindings, AreNoneForRowsThatDoNotCountOrAreNotPublished) {
  std::vector<ResultRow> rows{small("serial", 1), small("opencl", 0.5)};
  rows[1].verified = false;
  EXPECT_TRUE(about(order_findings, rows).empty());
  rows[1].verified = true;
  for (ResultRow& row : rows) row.nodes = 2501;
  EXPECT_TRUE(about(order_findings, rows).empty());
  EXPECT_TRUE(about(order_findings, {}).empty());
}

TEST(CostFindings, HoldMeasuredCostsAgainstPublishedOnes) {
  const std::string published =
      "a step of rk4 costs 1.23 (1.23 to 1.23) steps of semi-euler, about what one force "
      "evaluation costs, though the method has 4 force evaluations. Measured, `";
  const auto with = [](const std::string& integrator, double ms) {
    return about(cost_findings, {small("serial", 1), small("serial", ms, integrator)});
  };
  EXPECT_EQ(outcome(with("rk4", 4), published + "rk4` with 4 force evaluations: `serial` 4.00"),
            Outcome::not_reproduced);
  EXPECT_EQ(
      outcome(with("rk4-frozen", 1.3), published + "rk4-frozen` with 1 force evaluation: `serial` 1.30"),
      Outcome::reproduced);
  EXPECT_EQ(outcome(with("rk4", 1.23 * cost_tolerance * 0.99), published), Outcome::reproduced);
}

TEST(CostFindings, CountTheSizesAtWhichAStepCostsLess) {
  const auto findings = about(
      cost_findings, {small("opencl", 1), small("opencl", 0.9, "rk4"), small("opencl", 1.1, "rk4-frozen")});
  EXPECT_EQ(
      outcome(findings,
              "costs 0.924 (0.924 to 0.924, below 1 at 1 of 1 size) steps of semi-euler, about what one "
              "force evaluation costs, though the method has 4 force evaluations. Measured, `rk4` with "
              "4 force evaluations: `opencl` 0.900 (0.900 to 0.900, below 1 at 1 of 1 size)."),
      Outcome::reproduced);
  EXPECT_EQ(outcome(findings, "`opencl` 1.10 (1.10 to 1.10)."), Outcome::reproduced);
}

TEST(CostFindings, ArePartlyReproducedWhereBackendsDiffer) {
  const auto findings = about(cost_findings, {small("threads-mutex", 1), small("openmp", 1),
                                              small("threads-mutex", 4, "rk4"), small("openmp", 1.2, "rk4")});
  EXPECT_EQ(outcome(findings, "with Multi-thread CPU a step of rk4"), Outcome::partly);
}

TEST(TrendFindings, SayWhetherASpeedUpFallsWhereThePublishedOneDoes) {
  const auto with = [](double ms) {
    return about(trend_findings,
                 {cloth_row(10000, 118004, "serial", 1), cloth_row(40000, 476004, "serial", 4),
                  cloth_row(10000, 118004, "opencl", 0.1), cloth_row(40000, 476004, "opencl", ms)});
  };
  const std::string published =
      "the speed-up of GPU falls in 1 of 1 step from one size to the next, most from "
      "10,000 to 40,000 nodes with semi-euler (28.8× to 16.4×). There the measured one of "
      "`opencl` ";
  EXPECT_EQ(outcome(with(0.8), published + "falls, too (10.0× to 5.00×)"), Outcome::reproduced);
  EXPECT_EQ(outcome(with(0.2), published + "rises (10.0× to 20.0×)"), Outcome::not_reproduced);
  EXPECT_EQ(outcome(with(0.4), published + "does not certainly change"), Outcome::undecided);
}

TEST(TrendFindings, AreCertainOnlyWhereIntervalsAreApart) {
  // Speed-ups at 10,000 and 40,000 nodes, as three rounds have them.
  using Rounds = std::vector<double>;
  const auto with = [](const Rounds& from, const Rounds& to) {
    std::vector<ResultRow> rows{cloth_row(10000, 118004, "serial", 1), cloth_row(40000, 476004, "serial", 1),
                                cloth_row(10000, 118004, "opencl", 1), cloth_row(40000, 476004, "opencl", 1)};
    for (std::size_t round = 0; round < 3; ++round) {
      rows[2].samples_ms[round] = rows[0].samples_ms[round] / from[round];
      rows[3].samples_ms[round] = rows[1].samples_ms[round] / to[round];
    }
    return about(trend_findings, rows);
  };
  const std::string there = "There the measured one of `opencl` ";
  EXPECT_EQ(outcome(with({10, 10, 10}, {5, 9, 4}), there + "falls, too (10.0× to 5.00×)"),
            Outcome::reproduced);
  EXPECT_EQ(outcome(with({10, 10, 10}, {5, 11, 4}), there + "does not certainly change (10.0× to 5.00×)"),
            Outcome::undecided);
  EXPECT_EQ(outcome(with({10, 6, 12}, {5, 7, 4}), there + "does not certainly change"), Outcome::undecided);
  EXPECT_EQ(outcome(with({10, 10, 10}, {20, 11, 30}), there + "rises (10.0× to 20.0×)"),
            Outcome::not_reproduced);
  EXPECT_EQ(outcome(with({10, 10, 10}, {20, 9, 30}), there + "does not certainly change"),
            Outcome::undecided);
  EXPECT_EQ(outcome(with({10, 10, 22}, {20, 21, 30}), there + "does not certainly change"),
            Outcome::undecided);
}

TEST(TrendFindings, TakeAPublishedFallOfAFewPercentForNone) {
  // Published, GPU with semi-euler: 1642.693 / 67.130 = 24.5 at 200,000 nodes, 2733.484 / 115.015 = 23.8 at
  // 350,000.
  const auto findings = about(
      trend_findings, {cloth_row(200000, 2391004, "serial", 1), cloth_row(350000, 4188004, "serial", 1),
                       cloth_row(200000, 2391004, "opencl", 0.1), cloth_row(350000, 4188004, "opencl", 0.1)});
  EXPECT_EQ(outcome(findings, "the speed-up of GPU never falls"), Outcome::reproduced);
}

TEST(TrendFindings, SayWhetherASpeedUpNeverFalls) {
  const auto with = [](double ms) {
    return about(trend_findings,
                 {small("serial", 1), larger("serial", 2), small("openmp", 0.1), larger("openmp", ms)});
  };
  EXPECT_EQ(
      outcome(with(0.1), "never falls from one size to the next. Measured: that of `openmp` falls in 0"),
      Outcome::reproduced);
  EXPECT_EQ(outcome(with(0.4), "that of `openmp` falls in 1 of 1 step"), Outcome::not_reproduced);
}

TEST(RowFindings, NameRowsThatAreNotVerified) {
  std::vector<ResultRow> rows{small("serial", 1), small("openmp", 0.5)};
  const Provenance provenance = made_up_provenance();
  EXPECT_EQ(outcome(row_findings(rows, provenance), "2 rows have a time, and all are verified"),
            Outcome::fact);
  rows[1].verified = false;
  EXPECT_EQ(outcome(row_findings(rows, provenance),
                    "1 row is not verified, and counts nowhere: `openmp` on `cloth2500`, semi-euler"),
            Outcome::warning);
  rows[1] = failed_row("openmp", "unavailable: no device");
  EXPECT_EQ(outcome(row_findings(rows, provenance), "1 row has no time"), Outcome::fact);
  EXPECT_TRUE(row_findings({}, provenance).empty());
}

TEST(RowFindings, NameSpeedUpsThatMayBeOne) {
  std::vector<ResultRow> rows{small("serial", 1), small("openmp", 0.5)};
  EXPECT_EQ(outcome(row_findings(rows, {}),
                    "Of 1 speed-up over `serial`, all have an interval that does not hold 1"),
            Outcome::fact);
  rows[1].samples_ms = {3, 0.25, 1};
  EXPECT_EQ(
      outcome(
          row_findings(rows, {}),
          "1 interval holds 1, so that neither is certainly the faster: `openmp` on `cloth2500`, semi-euler "
          "(0.667 to 2.00)"),
      Outcome::fact);
  rows.erase(rows.begin());
  EXPECT_EQ(outcome(row_findings(rows, {}), "There are no speed-ups"), Outcome::fact);
}

TEST(GarmentFindings, SayWhetherParallelisationIsFaster) {
  std::vector<ResultRow> rows{small("serial", 1), small("openmp", 0.5)};
  EXPECT_TRUE(garment_findings(rows).empty());
  for (ResultRow& row : rows) {
    row.dressing.emplace();
    row.dressing->wall_s = 0.75;
  }
  EXPECT_EQ(outcome(garment_findings(rows), "`openmp` is faster than `serial` in 1 of 1 size"),
            Outcome::reproduced);
  EXPECT_EQ(outcome(garment_findings(rows), "dresses `cloth2500` (2,500 vertices) in 0.750 s"),
            Outcome::fact);
  rows[1] = small("openmp", 2);
  rows[1].dressing.emplace();
  EXPECT_EQ(outcome(garment_findings(rows), "`openmp` is faster than `serial` in 0 of 1 size, slower in 1"),
            Outcome::not_reproduced);
}

TEST(TimesAsFast, TakesTheIntervalsOfTimesWhereThereAreNoPairs) {
  ResultRow row = small("openmp", 1), than = small("serial", 4);
  EXPECT_EQ(times_as_fast(&row, &than)->low, 4);
  row.samples_ms.pop_back();
  const auto ratio = times_as_fast(&row, &than);
  EXPECT_EQ(ratio->ratio, 4);
  EXPECT_EQ(ratio->low, 1);
  EXPECT_EQ(ratio->high, 16);
  row.ms_per_step_low = row.ms_per_step_high = std::nullopt;
  EXPECT_EQ(times_as_fast(&row, &than)->low, 2);
  row.verified = false;
  EXPECT_FALSE(times_as_fast(&row, &than));
}

TEST(ExponentOf, IsTheSlopeOnLogarithmicAxes) {
  const std::vector<double> x{1, 10, 100}, y{5, 500, 50000};
  EXPECT_NEAR(*exponent_of(x, y), 2, 1e-12);
  EXPECT_FALSE(exponent_of(std::vector<double>{3, 3}, std::vector<double>{1, 2}));
  EXPECT_FALSE(exponent_of({}, {}));
}

}  // namespace
}  // namespace mssim
