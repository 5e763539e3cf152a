#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "bench/roofline/roofline.h"
#include "garment/output/garment_tables.h"
#include "integrators/all_integrators.h"
#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {
namespace {

Series published_series(std::string_view configuration, const std::string& family) {
  const auto found = std::ranges::find(paper_configurations, configuration, &PaperConfiguration::name);
  return {.name = std::string(found == paper_configurations.end() ? configuration : found->caption) +
                  ", published",
          .origin = Origin::published,
          .family = family};
}

void add_point(Series& series, std::uint64_t nodes, double y) { series.add(static_cast<double>(nodes), y); }

/// The time of a row that counts, with its interval.
void add_time(Series& series, const ResultRow& row) {
  add_point(series, row.nodes, *row.ms_per_step);
  series.low.push_back(row.ms_per_step_low.value_or(*row.ms_per_step));
  series.high.push_back(row.ms_per_step_high.value_or(*row.ms_per_step));
}

Chart chart_of(const std::string& id, const std::string& title, Axis x, Axis y,
               ChartForm form = ChartForm::lines) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.form = form;
  chart.x = std::move(x);
  chart.y = std::move(y);
  return chart;
}

constexpr std::array<std::string_view, 4> kind_names{"cloths", "bodies", "garments", "other scenes"};

/// The times of a backend with an integrator on scenes of a kind, by size, with what was published of them.
struct SizeLines {
  std::vector<const ResultRow*> rows;
  std::string configuration;  ///< that the backend stands for; empty: none
  Series measured, published;
  /// The exponents of time over nodes; none of fewer than two sizes.
  std::optional<double> measured_slope, published_slope;
};

SizeLines size_lines(std::span<const ResultRow> rows, const PaperLegend& legend,
                     std::span<const PublishedTable> published, ContentKind kind, const std::string& backend,
                     const std::string& integrator) {
  SizeLines lines;
  for (const ResultRow& row : rows)
    if (kind_of(row) == kind && row.backend == backend && row.integrator == integrator && counts(row))
      lines.rows.push_back(&row);
  std::ranges::stable_sort(lines.rows, {}, [](const ResultRow* row) { return row->nodes; });
  const auto of_backend = std::ranges::find(legend.backends, backend, &PaperLegend::Backend::name);
  if (of_backend != legend.backends.end()) lines.configuration = of_backend->configuration;
  const auto method = std::ranges::find(legend.integrators, integrator, &PaperLegend::Integrator::name);
  lines.measured = {.name = backend + ", measured", .family = backend};
  lines.published = published_series(lines.configuration, backend);
  for (const ResultRow* row : lines.rows) {
    add_time(lines.measured, *row);
    if (method == legend.integrators.end() || !row->scene_as_shipped) continue;
    for (const PublishedTable& table : published)
      if (const auto ms =
              table.ms(method->paper_name, lines.configuration, row->nodes, row->springs_published))
        add_point(lines.published, row->nodes, *ms);
  }
  lines.measured_slope = exponent_of(lines.measured.x, lines.measured.y);
  lines.published_slope = exponent_of(lines.published.x, lines.published.y);
  return lines;
}

Series with_slope(Series series, std::optional<double> slope) {
  if (slope) series.name += fmt::format(", slope {:.2f}", *slope);
  return series;
}

/// Values of the rows, in the order in which they appear, each once.
std::vector<std::string> distinct(std::span<const ResultRow> rows, std::string ResultRow::*value) {
  std::vector<std::string> values;
  for (const ResultRow& row : rows)
    if (std::ranges::find(values, row.*value) == values.end()) values.push_back(row.*value);
  return values;
}

/// Where a row stands in a roofline: operations a byte, and 1e9 operations a second.
struct RoofDot {
  double intensity = 0, gigaflops = 0;
  std::optional<double> roof;  ///< at this intensity
};

std::optional<RoofDot> dot_of(const ResultRow& row) {
  const Integrator* integrator = find_integrator(row.integrator);
  if (!integrator || is_implicit(*integrator) || !counts(row) || !row.gigabytes_per_second ||
      !(*row.gigabytes_per_second > 0))
    return std::nullopt;
  // Operations do not depend on how springs lie in memory or how often a backend passes over the state.
  const double flops = step_cost(*integrator, {row.nodes, row.springs_unique, 0}).flops;
  RoofDot dot;
  dot.gigaflops = flops / *row.ms_per_step / 1e6;
  dot.intensity = dot.gigaflops / *row.gigabytes_per_second;
  if (row.roofline_fraction && *row.roofline_fraction > 0) dot.roof = dot.gigaflops / *row.roofline_fraction;
  return dot;
}

/// The roof that dots of as many threads lie under: bandwidth times intensity, up to a ceiling where any dot
/// shows that there is one. Such dots were held against the same peaks.
Series roof_line(int threads, const std::vector<RoofDot>& dots, double from, double to) {
  double bandwidth = 0, ceiling = 0;
  for (const RoofDot& dot : dots) {
    bandwidth = std::max(bandwidth, *dot.roof / dot.intensity);
    ceiling = std::max(ceiling, *dot.roof);
  }
  const bool has_ceiling = std::ranges::any_of(
      dots, [&](const RoofDot& dot) { return *dot.roof < 0.999 * bandwidth * dot.intensity; });
  Series line{.name = "roof of " + pluralize(threads, "thread"),
              .origin = Origin::reference,
              .x = {from},
              .y = {from * bandwidth}};
  if (const double ridge = ceiling / bandwidth; has_ceiling && ridge > from && ridge < to)
    line.add(ridge, ceiling);
  line.add(to, has_ceiling ? std::min(to * bandwidth, ceiling) : to * bandwidth);
  return line;
}

}  // namespace

std::vector<Chart> speedup_charts(const PaperScenes& scenes, const std::string& id) {
  std::vector<Chart> charts;
  const std::vector<std::string> one_thread = scenes.backends_of(one_thread_configuration);
  if (std::ranges::find(one_thread, baseline_name) == one_thread.end()) return charts;
  for (const PaperLegend::Integrator& integrator : scenes.legend().integrators) {
    if (integrator.name != integrator.paper_name) continue;
    Chart chart =
        chart_of(id + "-speed-up-" + integrator.name, integrator.name + ": speed-up over one thread",
                 {"nodes", true}, {"times as fast as one thread", true});
    bool is_measured = false;
    for (const PaperConfiguration& configuration : paper_configurations) {
      if (configuration.name == one_thread_configuration) continue;
      const std::vector<std::string> backends = scenes.backends_of(configuration.name);
      Series published = published_series(configuration.name, backends.empty() ? "" : backends.front());
      for (const PaperScene& scene : scenes.scenes())
        if (const auto speedup = scenes.published_speedup(scene, integrator.paper_name, configuration.name))
          add_point(published, scene.nodes, *speedup);
      if (!published.x.empty()) chart.series.push_back(std::move(published));
      for (const std::string& backend : backends) {
        Series measured{.name = backend + ", measured", .family = backend};
        for (const PaperScene& scene : scenes.scenes()) {
          const auto speedup = times_as_fast(scenes.row(scene, backend, integrator.name),
                                             scenes.row(scene, baseline_name, integrator.name));
          if (!speedup) continue;
          add_point(measured, scene.nodes, speedup->ratio);
          measured.low.push_back(speedup->low);
          measured.high.push_back(speedup->high);
        }
        if (measured.x.empty()) continue;
        is_measured = true;
        chart.series.push_back(std::move(measured));
      }
    }
    if (is_measured) charts.push_back(std::move(chart));
  }
  return charts;
}

std::optional<Chart> figure6_chart(std::span<const ResultRow> rows, const std::string& id) {
  Chart chart = chart_of(id + "-figure6", "Figure 6: one iteration of jeans", {"vertices", false},
                         {"time of an iteration (ms)", false});
  for (const ResultRow& row : rows) {
    if (!row.dressing || !counts(row)) continue;
    const std::string name =
        row.backend + (is_parallel(row.backend) ? ", with parallelisation" : ", without parallelisation");
    auto series = std::ranges::find(chart.series, name, &Series::name);
    if (series == chart.series.end())
      series = chart.series.insert(series, Series{.name = name, .family = row.backend});
    add_time(*series, row);
  }
  return chart.series.empty() ? std::nullopt : std::optional(std::move(chart));
}

ContentKind kind_of(const ResultRow& row) {
  if (row.springs_published == 2 * row.springs_unique) return ContentKind::cloth;
  if (row.springs_published == 3 * row.springs_unique) return ContentKind::bodies;
  return row.dressing ? ContentKind::garment : ContentKind::other;
}

std::vector<Chart> scaling_charts(std::span<const ResultRow> rows, const PaperLegend& legend,
                                  std::span<const PublishedTable> published, const std::string& id) {
  std::vector<Chart> charts;
  if (rows.empty()) return charts;
  const std::string integrator = rows.front().integrator;
  for (std::size_t kind = 0; kind < kind_names.size(); ++kind) {
    Chart chart = chart_of(fmt::format("{}-scaling-{}", id, kind),
                           fmt::format("Time of a {} step of {}", integrator, kind_names[kind]),
                           {"nodes", true}, {"time of a step (ms)", true});
    std::vector<std::string> shown;
    for (const std::string& backend : distinct(rows, &ResultRow::backend)) {
      SizeLines lines =
          size_lines(rows, legend, published, static_cast<ContentKind>(kind), backend, integrator);
      if (!lines.measured_slope) continue;
      chart.series.push_back(with_slope(std::move(lines.measured), lines.measured_slope));
      if (lines.published.x.empty() || std::ranges::find(shown, lines.configuration) != shown.end()) continue;
      shown.push_back(lines.configuration);
      chart.series.push_back(with_slope(std::move(lines.published), lines.published_slope));
    }
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

std::vector<Chart> thread_charts(std::span<const ResultRow> rows, const Provenance& provenance,
                                 const std::string& id) {
  std::vector<Chart> charts;
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  const ResultRow* last = nullptr;
  for (const ThreadRow& of : thread_rows(pointers, provenance)) {
    const std::optional<RatioInterval> speedup = of.speedup();
    if (!speedup || of.row->integrator != rows.front().integrator) continue;
    if (!last || last->scene != of.row->scene) {
      charts.push_back(
          chart_of(fmt::format("{}-threads-{}", id, charts.size()),
                   of.row->scene + ", " + of.row->integrator + ": speed-up over the fewest threads",
                   {"threads", true}, {"times as fast", true}));
      charts.back().series.push_back({.name = "as many times as threads", .origin = Origin::reference});
    }
    last = of.row;
    std::vector<Series>& all = charts.back().series;
    auto series = std::ranges::find(all, of.backend, &Series::family);
    if (series == all.end())
      series = all.insert(series, {.name = std::string(of.backend), .family = std::string(of.backend)});
    if (all.size() == 2) all.front().add(of.threads, static_cast<double>(of.threads) / of.fewest_threads);
    series->add(of.threads, speedup->ratio);
    series->low.push_back(speedup->low);
    series->high.push_back(speedup->high);
  }
  return charts;
}

Table slope_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                  std::span<const PublishedTable> published) {
  Table table;
  for (std::size_t kind = 0; kind < kind_names.size(); ++kind)
    for (const std::string& integrator : distinct(rows, &ResultRow::integrator))
      for (const std::string& backend : distinct(rows, &ResultRow::backend)) {
        const SizeLines lines =
            size_lines(rows, legend, published, static_cast<ContentKind>(kind), backend, integrator);
        if (lines.measured_slope)
          table.add({{"backend", "`" + backend + "`"},
                     {"integrator", integrator},
                     {"scenes", std::string(kind_names[kind]) + ", " + grouped(lines.rows.front()->nodes) +
                                    " to " + grouped(lines.rows.back()->nodes) + " nodes"},
                     {"measured slope", *lines.measured_slope},
                     {"published slope", lines.published_slope}});
      }
  return table;
}

std::optional<Chart> roofline_chart(std::span<const ResultRow> rows, const std::string& id) {
  const ResultRow* largest = nullptr;
  for (const ResultRow& row : rows)
    if (row.roofline_fraction && dot_of(row) && (!largest || row.nodes > largest->nodes)) largest = &row;
  if (!largest) return std::nullopt;
  Chart chart = chart_of(id + "-roofline", "Roofline: " + largest->scene + ", " + largest->integrator,
                         {"operations a byte", true}, {"operations a second (10⁹)", true}, ChartForm::points);
  std::map<int, std::vector<RoofDot>> under_roof;  // by threads
  double least = INFINITY, most = 0;
  for (const ResultRow& row : rows) {
    if (row.scene != largest->scene || row.integrator != largest->integrator) continue;
    const auto dot = dot_of(row);
    if (!dot) continue;
    chart.series.push_back(
        {.name = row.backend, .family = row.backend, .x = {dot->intensity}, .y = {dot->gigaflops}});
    if (dot->roof) under_roof[row.threads].push_back(*dot);
    least = std::min(least, dot->intensity);
    most = std::max(most, dot->intensity);
  }
  for (const auto& [threads, dots] : under_roof)
    chart.series.push_back(roof_line(threads, dots, least / 2, most * 2));
  return chart;
}

Chart energy_chart(const FoundCurve& curve, std::span<const FoundCurve> references, const std::string& id) {
  // More points would hide the reference.
  constexpr std::size_t most_points = 40;
  Chart chart = chart_of(id, "Total energy: " + curve.name, {"time (s)", false}, {"total energy (J)", false});
  Series& points = chart.series.emplace_back(Series{.name = curve.name, .family = ""});
  const std::size_t count = curve.time_s.size(), apart = std::max<std::size_t>(1, count / most_points);
  for (std::size_t i = 0; i < count; i += apart) points.add(curve.time_s[i], curve.total_j[i]);
  const FoundCurve* best = nullptr;
  for (const FoundCurve& reference : references)
    if (curve.name.starts_with(reference.name) && (!best || reference.name.size() > best->name.size()))
      best = &reference;
  if (best)
    chart.series.push_back({.name = "reference of " + best->name,
                            .origin = Origin::reference,
                            .x = best->time_s,
                            .y = best->total_j});
  return chart;
}

}  // namespace mssim
