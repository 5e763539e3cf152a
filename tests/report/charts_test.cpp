#include "application/bench/suites.h"
#include "charts/layout.h"
#include "integrators/all_integrators.h"
#include "report/report_internal.h"
#include "tests/support/report_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Cloths of Table 1 with `serial`, `openmp` and `opencl`.
std::vector<ResultRow> two_cloths() {
  std::vector<ResultRow> rows;
  for (const auto& [nodes, springs, ms] : {std::tuple(2500U, 29004U, 1.0), std::tuple(10000U, 118004U, 8.0)})
    for (const auto& [backend, ratio] :
         {std::pair("serial", 1.0), std::pair("openmp", 10.0), std::pair("opencl", 5.0)}) {
      rows.push_back(cloth_row(nodes, springs, backend, ms / ratio));
      rows.back().speedup_vs_serial = ratio;
    }
  return rows;
}

const Series& series(const Chart& chart, const std::string& name) {
  for (const Series& each : chart.series)
    if (each.name == name) return each;
  ADD_FAILURE() << chart.id << " has no series " << name;
  return chart.series.front();
}

std::vector<std::string> names_in(const Chart& chart) {
  std::vector<std::string> names;
  for (const Series& series : chart.series) names.push_back(series.name);
  return names;
}

TEST(SpeedupCharts, ShowPublishedBesideMeasured) {
  const auto charts = speedup_charts(folder_of(two_cloths(), made_up_provenance()), of_papers(), "f1");
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(charts[0].id, "f1-table1-speed-up-semi-euler");
  EXPECT_EQ(charts[0].subtitle, "Measured on A Processor, 2 threads");
  EXPECT_TRUE(charts[0].x.ticks_at_values);
  EXPECT_EQ(charts[0].series.size(), 4U);
  const Series &published = series(charts[0], "GPU, Nexus 7, published"),
               &measured = series(charts[0], "opencl, measured");
  EXPECT_EQ(published.origin, Origin::published);
  EXPECT_EQ(published.family, measured.family);
  EXPECT_EQ(published.x, measured.x);
  EXPECT_NEAR(published.y[1], 28.8355, 1e-4);
  EXPECT_TRUE(published.low.empty());
  EXPECT_EQ(measured.y, (std::vector<double>{5, 5}));
  EXPECT_EQ(measured.low, measured.y);
  EXPECT_TRUE(speedup_charts(folder_of({}), of_papers(), "f1").empty());
}

TEST(SpeedupCharts, OpenclOnTheProcessorLooksLikeNoGpu) {
  std::vector<ResultRow> rows = two_cloths();
  const auto chart_on = [&](const std::string& device) {
    for (ResultRow& row : rows)
      if (row.backend == "opencl") row.device = device;
    return speedup_charts(folder_of(rows, made_up_provenance()), of_papers(), "f1").at(0);
  };
  const Chart on_cpu = chart_on("pthread-skylake-avx512-A Processor"), on_gpu = chart_on("A GPU");
  EXPECT_NE(series(on_cpu, "opencl on the CPU, measured").family,
            series(on_cpu, "GPU, Nexus 7, published").family);
  EXPECT_EQ(series(on_gpu, "opencl, A GPU, measured").family,
            series(on_gpu, "GPU, Nexus 7, published").family);
  EXPECT_EQ(series(on_cpu, "GPU, Nexus 7, published").family,
            series(on_gpu, "GPU, Nexus 7, published").family);
  const std::vector<std::string> families = families_of_backends(legend);
  const auto looks = looks_of(on_cpu.series, families);
  EXPECT_EQ(std::set(looks.begin(), looks.end()).size(), on_cpu.series.size());
  for (const char* family : {"opencl", "hybrid", "opencl on the CPU", "hybrid on the CPU"})
    EXPECT_THAT(families, Contains(family));
}

TEST(FamiliesOfBackends, LeaveAColourForAnotherRow) {
  const std::vector<std::string> families = families_of_backends(paper_legend());
  EXPECT_LT(families.size(), series_colours.size());
  for (const char* family : {"serial", "threads-mutex", "openmp", "opencl", "opencl on the CPU", "hybrid",
                             "hybrid on the CPU", "webgpu", "webgpu on the CPU", "wasm", "wasm-threads"})
    EXPECT_THAT(families, Contains(family));
}

TEST(LookOn, NamesTheDevice) {
  const Provenance provenance = made_up_provenance();
  EXPECT_EQ(look_on("", "hybrid", provenance).name, "hybrid");
  EXPECT_EQ(look_on("pthread-znver4-A Processor", "hybrid", provenance).name, "hybrid on the CPU");
  EXPECT_EQ(look_on("A GPU", "hybrid", provenance).name, "hybrid, A GPU");
  EXPECT_EQ(look_on("A GPU", "hybrid", provenance).family, "hybrid");
}

TEST(ValuesOf, ShowAChartOfOnePlaceAsATable) {
  std::vector<ResultRow> rows = two_cloths();
  rows[2].samples_ms[0] = 0.5;  // of 2 ms of serial
  const auto chart_of = [&](std::ptrdiff_t count) {
    return speedup_charts(folder_of({rows.begin(), rows.begin() + count}), of_papers(), "f1").at(0);
  };
  EXPECT_FALSE(has_one_place(chart_of(6)));
  const Chart chart = chart_of(3);
  EXPECT_TRUE(has_one_place(chart));
  EXPECT_THAT(to_text(values_of(chart), ListingFormat::csv),
              AllOf(HasSubstr("\n2500,\"GPU, Nexus 7, published\",10.65"),
                    HasSubstr("2500,\"opencl, measured\",5.0,4.00 to 5.00")));
  rows[2].samples_ms.resize(5);
  rows[0].samples_ms.resize(5);
  EXPECT_THAT(to_text(values_of(chart_of(3)), ListingFormat::csv),
              HasSubstr("2500,\"opencl, measured\",5.0,\n"))
      << "five rounds have no interval";
  Chart changed = chart;
  changed.series.push_back({.name = "order 4", .origin = Origin::reference, .x = {2500}, .y = {1}});
  EXPECT_EQ(values_of(changed).rows.size(), values_of(chart).rows.size()) << "a reference is no value";
  changed.x.ticks_at_values = false;
  EXPECT_FALSE(has_one_place(changed)) << "seconds are no whole numbers";
}

TEST(ScalingCharts, NameTheSlopes) {
  const std::vector<ResultRow> rows = two_cloths();
  const auto charts = scaling_charts(folder_of(rows, made_up_provenance()), of_papers(), "f1");
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_TRUE(charts[0].x.logarithmic && charts[0].y.logarithmic);
  EXPECT_EQ(series(charts[0], "serial, measured, slope 1.50").high, (std::vector<double>{2, 16}));
  std::vector<ResultRow> few = rows;
  few[0].rounds = 5;
  EXPECT_EQ(series(scaling_charts(folder_of(few), of_papers(), "f1")[0], "serial, measured, slope 1.50").high,
            (std::vector<double>{1, 16}));
  EXPECT_EQ(series(charts[0], "CPU only, Nexus 7, published, slope 1.02").y,
            (std::vector<double>{19.475, 80.48}));
  const Table slopes = slope_table(folder_of(rows), of_papers());
  EXPECT_EQ(slopes.rows.size(), 3U);
  EXPECT_TRUE(scaling_charts(folder_of({rows.begin(), rows.begin() + 3}), of_papers(), "f1").empty());
}

TEST(ThreadCharts, ShowSpeedUpsOverTheFewestThreadsBesideTheNumberOfThreads) {
  std::vector<ResultRow> rows{measured_row("serial", 4, 1.0),       measured_row("openmp:1", 1, 4.0),
                              measured_row("openmp:2", 0.625, 6.4), measured_row("openmp", 0.5, 8.0),
                              measured_row("hybrid:1", 2, 2.0),     measured_row("hybrid", 1, 4.0)};
  Provenance provenance = made_up_provenance();
  provenance.threads = rows[3].threads = rows[5].threads = 4;
  const auto charts = scaling_charts(folder_of(rows, provenance), of_papers(), "f1");
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(charts[0].series.size(), 3U);
  EXPECT_EQ(series(charts[0], "openmp").x, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(series(charts[0], "openmp").y, (std::vector<double>{1, 1.6, 2}));
  EXPECT_EQ(series(charts[0], "hybrid").y, (std::vector<double>{1, 2}));
  EXPECT_EQ(charts[0].series.front().y, (std::vector<double>{1, 2, 4}));
  rows.resize(2);
  EXPECT_TRUE(scaling_charts(folder_of(rows, provenance), of_papers(), "f1").empty());
}

TEST(RooflineChart, PutsDotsBelowTheirRoofs) {
  std::vector<ResultRow> rows = two_cloths();
  for (ResultRow& row : rows) row.roofline_fraction = row.backend == "serial" ? 0.05 : 0.5;
  for (ResultRow& row : rows) row.gigabytes_per_second = 0.12 / *row.ms_per_step;
  for (ResultRow& row : rows)
    if (row.backend == "opencl") row.roofline_fraction.reset();
  const auto chart = roofline_chart(folder_of(rows), "f1");
  ASSERT_TRUE(chart);
  EXPECT_EQ(chart->title, "Roofline: cloth10000, semi-euler");
  const Series &serial = series(*chart, "serial"), &openmp = series(*chart, "openmp"),
               &roof = series(*chart, "roof of 2 threads");
  EXPECT_EQ(roof.origin, Origin::reference);
  ASSERT_EQ(roof.x.size(), 4U) << "two dots and two ends; opencl has no roof";
  EXPECT_NEAR(roof.y[1] + roof.y[2], serial.y[0] / 0.05 + openmp.y[0] / 0.5, 1e-9 * roof.y[1]);
  EXPECT_EQ(chart->series.size(), 4U);
  for (ResultRow& row : rows) row.roofline_fraction.reset();
  EXPECT_FALSE(roofline_chart(folder_of(rows), "f1"));
}

TEST(RooflineChart, DrawsARoofAtItsDotsOnly) {
  std::vector<ResultRow> rows = two_cloths();
  rows.erase(rows.begin(), rows.begin() + 4);
  rows[0].gigabytes_per_second = 10;
  rows[0].roofline_fraction = 0.5;
  rows[1].gigabytes_per_second = 0.5;  // ten times the intensity of openmp
  rows[1].roofline_fraction = 0.5;
  const auto chart = roofline_chart(folder_of(rows), "f1");
  const Series &roof = series(*chart, "roof of 2 threads"), &first = chart->series[0],
               &second = chart->series[1];
  ASSERT_EQ(roof.x.size(), 4U);
  EXPECT_EQ(std::minmax(first.x[0], second.x[0]), std::minmax(roof.x[1], roof.x[2]));
  EXPECT_EQ(std::minmax(2 * first.y[0], 2 * second.y[0]), std::minmax(roof.y[1], roof.y[2]));
  EXPECT_LT(roof.x[3], 1.2 * roof.x[2]) << "beyond its dots a roof is not known";
}

TEST(Figure6Chart, HasALineForEachBackendThatDresses) {
  std::vector<ResultRow> rows = two_cloths();
  const auto last_chart = [&] { return speedup_charts(folder_of(rows), of_papers(), "f1").back(); };
  EXPECT_NE(last_chart().id, "f1-figure6");
  for (ResultRow& row : rows)
    if (row.backend != "opencl") row.dressing.emplace();
  const Chart chart = last_chart();
  EXPECT_EQ(chart.id, "f1-figure6");
  EXPECT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(series(chart, "openmp, with parallelisation").y, (std::vector<double>{0.1, 0.8}));
}

TEST(HistoryCharts, CountCommitsAndNameWhatSeriesDifferIn) {
  std::vector<HistoryEntry> history;
  for (int commit = 0; commit < 3; ++commit)
    history.push_back(entry_of(made_up_provenance(),
                               std::vector{measured_row("serial", 1, 1.0), measured_row("opencl", 0.5, 2.0)},
                               std::to_string(commit)));
  const auto chart = [&] { return history_charts(machines_of(history).at(0), "history-1").at(0); };
  EXPECT_THAT(names_in(chart()), ElementsAre("serial", "opencl"));
  EXPECT_TRUE(chart().x.ticks_at_values) << "there is no commit between two, and none before the first";
  EXPECT_THAT(series(chart(), "serial").x, ElementsAre(1, 2, 3));
  history[1].rows[1].device = "pthread-haswell-A Processor";
  EXPECT_THAT(names_in(chart()), ElementsAre("serial", "opencl, cpu", "opencl, pthread-haswell-A Processor"));
  history[2].rows[0].nodes = 2501;
  EXPECT_THAT(names_in(chart()), ElementsAre("serial, 2500 nodes", "opencl, cpu",
                                             "opencl, pthread-haswell-A Processor", "serial, 2501 nodes"));
}

TEST(EnergyChart, TakesTheReferenceOfTheLongestName) {
  const std::vector<FoundCurve> references{
      {"cloth", {0}, {1}}, {"cloth2500", {0, 1}, {2, 3}}, {"box-small", {0}, {4}}};
  EXPECT_EQ(energy_chart({"cloth2500-rk4", {0}, {2}}, references, "f1-energy-0").series.at(1).y,
            (std::vector<double>{2, 3}));
  EXPECT_EQ(energy_chart({"torus", {0}, {2}}, references, "f1-energy-0").series.size(), 1U);
}

TEST(EnergyChart, HasAtMostFortyPointsFromTheFirstToTheLast) {
  for (const std::size_t count : {0U, 1U, 2U, 40U, 41U, 79U, 1000U}) {
    FoundCurve curve{"cloth", std::vector<double>(count), std::vector<double>(count, 1)};
    std::iota(curve.time_s.begin(), curve.time_s.end(), 0);
    const Series points = energy_chart(curve, {}, "f1-energy-0").series.at(0);
    ASSERT_EQ(points.x.size(), std::min<std::size_t>(count, 40)) << count;
    if (count == 0) continue;
    EXPECT_EQ(points.x.front(), curve.time_s.front());
    EXPECT_EQ(points.x.back(), curve.time_s.back());
    EXPECT_EQ(std::set(points.x.begin(), points.x.end()).size(), points.x.size());
  }
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

GuidePoint guide_point(const std::string& integrator, const std::string& backend, double dt_s, double wall_s,
                       double error) {
  return {.scene = "cloth",
          .integrator = integrator,
          .backend = backend,
          .dt_s = dt_s,
          .position_error = error,
          .wall_s_per_s = wall_s,
          .force_evaluations_per_s = integrator == "rk4" ? std::optional(4 / dt_s) : std::nullopt,
          .status = "ok"};
}

GuidePoint diverged_point(GuidePoint point, std::optional<double> error = std::nullopt) {
  point.diverged = true;
  point.status = "diverged";
  point.position_error = error;
  return point;
}

/// rk4 on two backends, implicit-euler on one, xpbd on none.
FoundGuide two_methods() {
  FoundGuide guide;
  guide.points = {
      diverged_point(guide_point("rk4", "serial", 0.004, 1, 0), 1e12),
      guide_point("rk4", "serial", 0.002, 4, 0.5),
      guide_point("rk4", "serial", 0.001, 8, 0.03),
      diverged_point(guide_point("rk4", "openmp", 0.004, 0.5, 0)),
      guide_point("rk4", "openmp", 0.002, 2, 0.5),
      guide_point("implicit-euler", "openmp", 0.02, 3, 2),
      {.scene = "cloth", .integrator = "xpbd", .backend = "openmp", .status = "no time was left"}};
  guide.points[1].on_front = guide.points[4].on_front = true;
  return guide;
}

std::vector<Chart> charts_of(const FoundGuide& guide, const Provenance& provenance = {}) {
  return guide_charts(guide, legend, provenance, "cloth", "f1");
}

const Chart& chart_called(const std::vector<Chart>& charts, const std::string& id) {
  for (const Chart& chart : charts)
    if (chart.id == id) return chart;
  ADD_FAILURE() << "no chart " << id;
  return charts.front();
}

TEST(GuideCharts, TakeTheCheapestBackendWithEachStep) {
  const auto charts = guide_charts(two_methods(), legend, {}, "cloth", "f1-guide-1");
  const Chart& work = chart_called(charts, "f1-guide-1-work-precision");
  EXPECT_TRUE(work.x.logarithmic && work.y.logarithmic);
  EXPECT_THAT(names_in(work), ElementsAre("rk4", "implicit-euler", "diverged", "on the front"));
  EXPECT_THAT(series(work, "rk4").x, ElementsAre(2, 8));
  EXPECT_THAT(series(work, "rk4").y, ElementsAre(0.5, 0.03));
  EXPECT_THAT(series(work, "on the front").x, ElementsAre(2));
  EXPECT_THAT(work.remarks, Contains(HasSubstr("1 of 2 points on the front")));
  EXPECT_THAT(work.remarks, Contains(HasSubstr(": openmp (implicit-euler), openmp and serial (rk4)")));
  EXPECT_THAT(work.remarks, Contains("No points: xpbd (no time was left)"));
  EXPECT_THAT(guide_charts(two_methods(), legend, {}, "other", "f1"), IsEmpty());
}

TEST(GuideCharts, PutDivergedPointsAtTheEdgeWhateverTheirError) {
  for (const Chart& chart : charts_of(two_methods())) {
    const Series& diverged = series(chart, "diverged");
    EXPECT_EQ(diverged.mark, PointMark::cross);
    EXPECT_THAT(diverged.y, ElementsAre(10)) << chart.id;
    EXPECT_THAT(chart.remarks, Contains(HasSubstr("Crosses at an error of 10 ")));
  }
  const auto charts = charts_of(two_methods());
  EXPECT_THAT(charts.front().remarks, Contains("Diverged: rk4 with 4.00 ms"));
}

TEST(GuideCharts, PreferABackendThatDidNotDiverge) {
  FoundGuide guide = two_methods();
  guide.points[0] = guide_point("rk4", "serial", 0.004, 1, 0.7);
  const auto charts = charts_of(guide);
  EXPECT_THAT(series(charts.front(), "rk4").x, ElementsAre(1, 2, 8));
  EXPECT_THAT(names_in(charts.front()), Not(Contains("diverged")));
}

TEST(GuideCharts, MarkWhatIsNotCompared) {
  FoundGuide guide = two_methods();
  guide.points[2].status = "within the reference's error";
  for (const Chart& chart : charts_of(guide)) {
    const Series& marked = series(chart, "not compared");
    EXPECT_EQ(marked.mark, PointMark::square);
    EXPECT_THAT(marked.y, ElementsAre(0.03));
    EXPECT_THAT(chart.remarks, Contains(HasSubstr("are not compared")));
  }
}

TEST(GuideCharts, ShowErrorsOverStepsWithTheirOrders) {
  const auto charts = charts_of(two_methods());
  const Chart& steps = chart_called(charts, "f1-error-step");
  EXPECT_THAT(names_in(steps), ElementsAre("rk4", "implicit-euler", "diverged", "order 1", "order 4"));
  EXPECT_THAT(series(steps, "rk4").x, ElementsAre(0.002, 0.001));
  for (const int order : {1, 4}) {
    const Series& line = series(steps, "order " + std::to_string(order));
    ASSERT_EQ(line.x.size(), 2U);
    EXPECT_NEAR(std::log(line.y[1] / line.y[0]) / std::log(line.x[1] / line.x[0]), order, 1e-9);
  }
}

TEST(GuideCharts, SayWhichMethodsHaveNoNumberOfEvaluations) {
  const auto charts = charts_of(two_methods());
  const Chart& evaluations = chart_called(charts, "f1-error-evaluations");
  EXPECT_THAT(names_in(evaluations), ElementsAre("rk4", "diverged"));
  EXPECT_THAT(series(evaluations, "rk4").x, ElementsAre(2000, 4000));
  EXPECT_THAT(evaluations.remarks, Contains("Without a fixed number of force evaluations: implicit-euler"));
}

TEST(GuideCharts, GiveEachIntegratorAColour) {
  FoundGuide guide;
  for (const Integrator* integrator : all_integrators)
    guide.points.push_back(guide_point(std::string(integrator->name), "serial", 0.001, 1, 0.1));
  const Chart chart = charts_of(guide, made_up_provenance()).at(0);
  EXPECT_EQ(chart.subtitle, "Measured on A Processor, 2 threads");
  std::set<std::string_view> colours;
  for (const std::size_t look : looks_of(chart.series, chart.families))
    colours.insert(series_colours.at(look % series_colours.size()));
  EXPECT_EQ(colours.size(), all_integrators.size());
}

TEST(GuideCharts, NameTheOnlyDeviceInSizes) {
  FoundGuide guide;
  for (const double nodes : {256.0, 529.0}) guide.times.push_back({"cloth", "rk4", "opencl", nodes, nodes});
  Provenance provenance = made_up_provenance();
  const auto names = [&] { return names_in(charts_of(guide, provenance).at(0)); };
  EXPECT_THAT(names(), ElementsAre("opencl"));
  provenance.opencl_devices = {"Portable Computing Language: pthread-A Processor, driver 3.1"};
  EXPECT_THAT(names(), ElementsAre("opencl on the CPU"));
  provenance.opencl_devices.emplace_back("NVIDIA CUDA: A GPU, driver 1");
  EXPECT_THAT(names(), ElementsAre("opencl")) << "which of both is not known";
}

TEST(GuideCharts, ShowSizesOfAnExplicitAndAnImplicitIntegrator) {
  FoundGuide guide;
  for (const char* integrator : {"implicit-euler", "rk4", "semi-euler", "xpbd"})
    for (const double nodes : {256.0, 529.0}) {
      guide.times.push_back({"cloth", integrator, "openmp", nodes, nodes / 100});
      if (nodes < 300) guide.times.push_back({"cloth", integrator, "serial", nodes, nodes / 10});
    }
  const auto charts = charts_of(guide);
  ASSERT_EQ(charts.size(), 2U);
  EXPECT_EQ(charts[0].id, "f1-sizes-explicit");
  EXPECT_EQ(charts[0].title, "cloth in other sizes, semi-euler");
  EXPECT_EQ(charts[1].title, "cloth in other sizes, implicit-euler");
  EXPECT_THAT(names_in(charts[0]), ElementsAre("openmp")) << "one size is no line";
  EXPECT_THAT(series(charts[0], "openmp").y, ElementsAre(2.56, 5.29));
}

}  // namespace
}  // namespace mssim
