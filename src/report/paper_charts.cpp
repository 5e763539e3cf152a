#include <algorithm>

#include "report/report_charts.h"
#include "report/times_as_fast.h"

namespace mssim {
namespace {

/// Adds the published line of a configuration; nothing where it has none.
void add_published_speedups(Chart& chart, const PaperScenes& scenes, const std::string& integrator,
                            const PaperConfiguration& configuration, const std::string& family) {
  Series series{
      std::string(configuration.caption) + ", published", Origin::published, family, {}, {}, {}, {}};
  for (const PaperScene& scene : scenes.scenes())
    if (const auto speedup = scenes.published_speedup(scene, integrator, configuration.name)) {
      series.x.push_back(static_cast<double>(scene.nodes));
      series.y.push_back(*speedup);
    }
  if (!series.x.empty()) chart.series.push_back(std::move(series));
}

void add_measured_speedups(Chart& chart, const PaperScenes& scenes, const std::string& integrator,
                           const std::string& backend, const std::string& one_thread) {
  Series series{backend + ", measured", Origin::measured, backend, {}, {}, {}, {}};
  for (const PaperScene& scene : scenes.scenes()) {
    const ResultRow* row = scenes.row(scene, backend, integrator);
    const ResultRow* base = scenes.row(scene, one_thread, integrator);
    const auto speedup = row && base ? times_as_fast(*row, *base) : std::nullopt;
    if (!speedup) continue;
    series.x.push_back(static_cast<double>(scene.nodes));
    series.y.push_back(speedup->ratio);
    series.low.push_back(speedup->low);
    series.high.push_back(speedup->high);
  }
  if (!series.x.empty()) chart.series.push_back(std::move(series));
}

}  // namespace

std::vector<Chart> speedup_charts(const PaperScenes& scenes, const std::string& id) {
  std::vector<Chart> charts;
  const std::vector<std::string> one_thread = scenes.backends_of(one_thread_configuration);
  if (one_thread.empty()) return charts;
  for (const PaperLegend::Integrator& integrator : scenes.legend().integrators) {
    if (integrator.name != integrator.paper_name) continue;
    Chart chart;
    chart.id = id + "-speed-up-" + integrator.name;
    chart.title = integrator.name + ": speed-up over one thread";
    chart.x = {"nodes", true};
    chart.y = {"times as fast as one thread", true};
    chart.families = backend_families;
    for (const PaperConfiguration& configuration : paper_configurations) {
      if (configuration.name == one_thread_configuration) continue;
      const std::vector<std::string> backends = scenes.backends_of(configuration.name);
      add_published_speedups(chart, scenes, integrator.paper_name, configuration,
                             backends.empty() ? std::string() : backends.front());
      for (const std::string& backend : backends)
        add_measured_speedups(chart, scenes, integrator.name, backend, one_thread.front());
    }
    const bool measured = std::ranges::any_of(
        chart.series, [](const Series& series) { return series.origin == Origin::measured; });
    if (measured) charts.push_back(std::move(chart));
  }
  return charts;
}

std::optional<Chart> figure6_chart(std::span<const ResultRow> rows, const std::string& id) {
  Chart chart;
  chart.id = id + "-figure6";
  chart.title = "Figure 6: one iteration of jeans";
  chart.x = {"vertices", false};
  chart.y = {"time of an iteration (ms)", false};
  chart.families = backend_families;
  for (const ResultRow& row : rows) {
    if (!row.dressing || !counts(row)) continue;
    const std::string name =
        row.backend + (row.backend == "serial" ? ", without parallelisation" : ", with parallelisation");
    auto series = std::ranges::find(chart.series, name, &Series::name);
    if (series == chart.series.end())
      series = chart.series.insert(series, {name, Origin::measured, row.backend, {}, {}, {}, {}});
    series->x.push_back(static_cast<double>(row.nodes));
    series->y.push_back(*row.ms_per_step);
    series->low.push_back(row.ms_per_step_low.value_or(*row.ms_per_step));
    series->high.push_back(row.ms_per_step_high.value_or(*row.ms_per_step));
  }
  return chart.series.empty() ? std::nullopt : std::optional(std::move(chart));
}

}  // namespace mssim
