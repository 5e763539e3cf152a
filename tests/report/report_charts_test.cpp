#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "report/report_internal.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

/// Cloths of Table 1 with `serial`, `openmp` and `opencl`.
std::vector<ResultRow> two_cloths() {
  std::vector<ResultRow> rows;
  for (const auto& [nodes, springs, ms] : {std::tuple(2500, 29004, 1.0), std::tuple(10000, 118004, 8.0)})
    for (const auto& [backend, ratio] :
         {std::pair("serial", 1.0), std::pair("openmp", 10.0), std::pair("opencl", 5.0)}) {
      ResultRow& row = rows.emplace_back(measured_row(backend, ms / ratio, ratio));
      row.scene = "cloth" + std::to_string(nodes);
      row.nodes = static_cast<std::uint64_t>(nodes);
      row.springs_published = springs;
      row.springs_unique = static_cast<std::uint64_t>(springs / 2);
    }
  return rows;
}

const Series& series(const Chart& chart, const std::string& name) {
  for (const Series& each : chart.series)
    if (each.name == name) return each;
  ADD_FAILURE() << chart.id << " has no series " << name;
  return chart.series.front();
}

TEST(SpeedupCharts, ShowPublishedBesideMeasured) {
  const std::vector<ResultRow> rows = two_cloths();
  const PublishedTable table1(published_table_kinds[0]);
  const auto charts = speedup_charts(PaperScenes(rows, legend, table1), "f1-table1");
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(charts[0].id, "f1-table1-speed-up-semi-euler");
  EXPECT_EQ(charts[0].series.size(), 4U);
  const Series &published = series(charts[0], "GPU, published"),
               &measured = series(charts[0], "opencl, measured");
  EXPECT_EQ(published.origin, Origin::published);
  EXPECT_EQ(published.family, measured.family);
  EXPECT_EQ(published.x, measured.x);
  EXPECT_NEAR(published.y[1], 28.8355, 1e-4);
  EXPECT_TRUE(published.low.empty());
  EXPECT_EQ(measured.y, (std::vector<double>{5, 5}));
  EXPECT_EQ(measured.low, measured.y);
  EXPECT_TRUE(speedup_charts(PaperScenes({}, legend, table1), "f1").empty());
}

TEST(ScalingCharts, NameTheSlopes) {
  const std::vector<ResultRow> rows = two_cloths();
  const std::vector<PublishedTable> published = published_tables();
  const auto charts = scaling_charts(rows, legend, published, "f1");
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_TRUE(charts[0].x.logarithmic && charts[0].y.logarithmic);
  EXPECT_EQ(series(charts[0], "serial, measured, slope 1.50").high, (std::vector<double>{2, 16}));
  EXPECT_EQ(series(charts[0], "CPU only, published, slope 1.02").y, (std::vector<double>{19.475, 80.48}));
  const Table slopes = slope_table(rows, legend, published);
  EXPECT_EQ(slopes.rows.size(), 3U);
  EXPECT_TRUE(scaling_charts(std::vector(rows.begin(), rows.begin() + 3), legend, published, "f1").empty());
}

TEST(RooflineChart, PutsDotsBelowTheirRoofs) {
  std::vector<ResultRow> rows = two_cloths();
  for (ResultRow& row : rows) row.roofline_fraction = row.backend == "serial" ? 0.05 : 0.5;
  for (ResultRow& row : rows) row.gigabytes_per_second = 0.12 / *row.ms_per_step;
  for (ResultRow& row : rows)
    if (row.backend == "opencl") row.roofline_fraction.reset();
  const auto chart = roofline_chart(rows, "f1");
  ASSERT_TRUE(chart);
  EXPECT_EQ(chart->title, "Roofline: cloth10000, semi-euler");
  const Series &dot = series(*chart, "openmp"), &roof = series(*chart, "roof of 2 threads");
  EXPECT_EQ(roof.origin, Origin::reference);
  ASSERT_EQ(roof.x.size(), 2U);
  EXPECT_NEAR(roof.y[1] / roof.x[1] * dot.x[0], dot.y[0] / 0.5, 1e-9 * dot.y[0]);
  EXPECT_EQ(chart->series.size(), 4U);
  for (ResultRow& row : rows) row.roofline_fraction.reset();
  EXPECT_FALSE(roofline_chart(rows, "f1"));
}

TEST(RooflineChart, EndsARoofAtItsCeiling) {
  std::vector<ResultRow> rows = two_cloths();
  rows.erase(rows.begin(), rows.begin() + 4);
  rows[0].gigabytes_per_second = 10;
  rows[0].roofline_fraction = 0.5;
  rows[1].gigabytes_per_second = 0.5;  // ten times the intensity of openmp
  rows[1].roofline_fraction = 0.5;
  const auto chart = roofline_chart(rows, "f1");
  const Series& roof = series(*chart, "roof of 2 threads");
  ASSERT_EQ(roof.x.size(), 3U);
  EXPECT_EQ(roof.y[1], roof.y[2]);
  EXPECT_LT(roof.x[1], roof.x[2]);
}

TEST(Figure6Chart, HasALineForEachBackendThatDresses) {
  std::vector<ResultRow> rows = two_cloths();
  EXPECT_FALSE(figure6_chart(rows, "f1"));
  for (ResultRow& row : rows)
    if (row.backend != "opencl") row.dressing.emplace();
  const auto chart = figure6_chart(rows, "f1");
  ASSERT_TRUE(chart);
  EXPECT_EQ(chart->series.size(), 2U);
  EXPECT_EQ(series(*chart, "openmp, with parallelisation").y, (std::vector<double>{0.1, 0.8}));
}

TEST(EnergyChart, TakesTheReferenceOfTheLongestName) {
  const std::vector<FoundCurve> references{
      {"cloth", {0}, {1}}, {"cloth2500", {0, 1}, {2, 3}}, {"box-small", {0}, {4}}};
  EXPECT_EQ(energy_chart({"cloth2500-rk4", {0}, {2}}, references, "f1-energy-0").series.at(1).y,
            (std::vector<double>{2, 3}));
  EXPECT_EQ(energy_chart({"torus", {0}, {2}}, references, "f1-energy-0").series.size(), 1U);
}

TEST(KindOf, FollowsFromHowSpringsAreCounted) {
  ResultRow row = measured_row("serial", 1, 1.0);
  EXPECT_EQ(kind_of(row), ContentKind::cloth);
  row.springs_published = 3 * row.springs_unique;
  EXPECT_EQ(kind_of(row), ContentKind::bodies);
  row.springs_published.reset();
  EXPECT_EQ(kind_of(row), ContentKind::other);
  row.dressing.emplace();
  EXPECT_EQ(kind_of(row), ContentKind::garment);
}

}  // namespace
}  // namespace mssim
