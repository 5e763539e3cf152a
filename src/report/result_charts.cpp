#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "bench/roofline/roofline.h"
#include "garment/output/garment_tables.h"
#include "integrators/all_integrators.h"
#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A published configuration has the look of its first backend.
Series published_series(std::string_view configuration, const PaperLegend& legend) {
  const auto* found = found_in(paper_configurations, configuration, &PaperConfiguration::name);
  const auto* backend = found_in(legend.backends, configuration, &PaperLegend::Backend::configuration);
  return {.name = fmt::format("{}, {}, published", found ? found->caption : configuration, paper_device),
          .origin = Origin::published,
          .family = backend ? backend->name : ""};
}

Series measured_series(const BackendLook& look) {
  return {.name = look.name + ", measured", .family = look.family};
}

Axis nodes_axis() { return {.label = "nodes", .logarithmic = true, .ticks_at_values = true}; }

void add_point(Series& series, std::uint64_t nodes, double y) { series.add(static_cast<double>(nodes), y); }

/// The time of a row that counts, with its interval; without one, its ends are the time.
void add_time(Series& series, const ResultRow& row) {
  add_point(series, row.nodes, *row.ms_per_step);
  series.low.push_back(has_interval(row) ? *row.ms_per_step_low : *row.ms_per_step);
  series.high.push_back(has_interval(row) ? *row.ms_per_step_high : *row.ms_per_step);
}

/// A ratio in the same way.
void add_ratio(Series& series, double x, const RatioInterval& ratio) {
  series.add(x, ratio.ratio);
  series.low.push_back(ratio.covers ? ratio.low : ratio.ratio);
  series.high.push_back(ratio.covers ? ratio.high : ratio.ratio);
}

constexpr const char* on_the_cpu = " on the CPU";

constexpr std::array<std::string_view, 4> kind_names{"cloths", "bodies", "garments", "other scenes"};

/// Measured and published times of a backend with an integrator on scenes of a kind, by size.
struct SizeLines {
  std::vector<const ResultRow*> rows;
  std::string configuration;  ///< of the paper; may be empty
  Series measured, published;
  /// Exponents of time over nodes; none with fewer than two sizes.
  std::optional<double> measured_slope, published_slope;
};

/// The look of a backend on the device of its rows.
BackendLook look_of(const ReportFolder& folder, std::string_view backend) {
  const ResultRow* row = row_with_device(pointers_to(folder.rows), backend);
  return look_on(row ? opencl_device(*row) : "", backend, folder.where_from());
}

SizeLines size_lines(const ReportFolder& folder, const ReportInput& input, ContentKind kind,
                     const std::string& backend, const std::string& integrator) {
  SizeLines lines;
  for (const ResultRow& row : folder.rows)
    if (kind_of(row) == kind && row.backend == backend && row.integrator == integrator && counts(row))
      lines.rows.push_back(&row);
  std::ranges::stable_sort(lines.rows, {}, [](const ResultRow* row) { return row->nodes; });
  lines.configuration = input.legend.configuration_of(backend);
  const auto* method = found_in(input.legend.integrators, integrator, &PaperLegend::Integrator::name);
  lines.measured = measured_series(look_of(folder, backend));
  lines.published = published_series(lines.configuration, input.legend);
  for (const ResultRow* row : lines.rows) {
    add_time(lines.measured, *row);
    if (!method || !row->scene_as_shipped) continue;
    for (const PublishedTable& table : input.published)
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

/// A row in a roofline: operations per byte, and 1e9 operations per second.
struct RoofDot {
  double intensity = 0, gigaflops = 0;
  std::optional<double> roof;  ///< at this intensity
};

std::optional<RoofDot> dot_of(const ResultRow& row) {
  const Integrator* integrator = find_integrator(row.integrator);
  if (!integrator || is_implicit(*integrator) || !counts(row) || !row.gigabytes_per_second ||
      !(*row.gigabytes_per_second > 0))
    return std::nullopt;
  // Operations depend neither on the layout of springs nor on how often a backend passes over the state.
  const double flops = step_cost(*integrator, {row.nodes, row.springs_unique, 0}).flops;
  RoofDot dot;
  dot.gigaflops = flops / *row.ms_per_step / 1e6;
  dot.intensity = dot.gigaflops / *row.gigabytes_per_second;
  if (row.roofline_fraction && *row.roofline_fraction > 0) dot.roof = dot.gigaflops / *row.roofline_fraction;
  return dot;
}

/// The roof for this number of threads at its dots. Elsewhere it is not known, because a row does not say
/// whether bandwidth or arithmetic is its limit; the ends only make a single dot's roof visible.
Series roof_line(int threads, std::vector<RoofDot> dots) {
  constexpr double end = 1.1;
  std::ranges::sort(dots, {}, &RoofDot::intensity);
  Series line{.name = "roof of " + pluralize(threads, "thread"), .origin = Origin::reference};
  line.add(dots.front().intensity / end, *dots.front().roof);
  for (const RoofDot& dot : dots) line.add(dot.intensity, *dot.roof);
  line.add(dots.back().intensity * end, *dots.back().roof);
  return line;
}

/// The backend and, if its combination has several series, what they differ in.
std::string name_in_chart(const HistorySeries& row, const MachineHistory& machine) {
  const auto differs = [&](auto member) {
    return std::ranges::any_of(machine.series, [&](const HistorySeries& other) {
      return same_combination(other, row) && other.*member != row.*member;
    });
  };
  return row.backend + (differs(&HistorySeries::device) ? ", " + row.device : "") +
         (differs(&HistorySeries::nodes) ? ", " + pluralize(row.nodes, "node") : "");
}

/// For each integrator of the paper: speed-ups over one thread against nodes, published and measured.
void add_speedup_charts(std::vector<Chart>& charts, const ReportFolder& folder, const PaperLegend& legend,
                        const PublishedTable& published, const std::string& id) {
  const std::vector<PaperScene> scenes = published.scenes_of(folder.rows);
  const std::vector<const ResultRow*> all = pointers_to(folder.rows);
  for (const PaperLegend::Integrator& integrator : legend.integrators) {
    if (integrator.name != integrator.paper_name) continue;
    Chart chart{.id = id + "-speed-up-" + integrator.name,
                .title = integrator.name + ": speed-up over one thread",
                .subtitle = where_measured(folder.where_from()),
                .x = nodes_axis(),
                .y = {"times as fast as one thread", true}};
    bool is_measured = false;
    for (const PaperConfiguration& configuration : paper_configurations) {
      if (configuration.name == one_thread_configuration) continue;
      Series line = published_series(configuration.name, legend);
      for (const PaperScene& scene : scenes)
        if (const auto speedup = published.speedup(integrator.paper_name, configuration.name, scene))
          add_point(line, scene.nodes, *speedup);
      if (!line.x.empty()) chart.series.push_back(std::move(line));
      for (const PaperLegend::Backend& backend : legend.backends) {
        if (backend.configuration != configuration.name) continue;
        Series measured = measured_series(look_of(folder, backend.name));
        for (const PaperScene& scene : scenes) {
          const ResultRow* row = find_row(all, scene.name, backend.name, integrator.name);
          const auto speedup = times_as_fast(row, row != nullptr ? baseline_of(all, *row) : nullptr);
          if (speedup) add_ratio(measured, static_cast<double>(scene.nodes), *speedup);
        }
        if (measured.x.empty()) continue;
        is_measured = true;
        chart.series.push_back(std::move(measured));
      }
    }
    if (is_measured) charts.push_back(std::move(chart));
  }
}

/// Figure 6 of Vassilev: milliseconds per iteration against vertices, of garments.
std::optional<Chart> figure6_chart(const ReportFolder& folder, const std::string& id) {
  Chart chart{.id = id + "-figure6",
              .title = "Figure 6: one iteration of garments",
              .subtitle = where_measured(folder.where_from()),
              .x = {"vertices"},
              .y = {"time per iteration (ms)"}};
  for (const ResultRow& row : folder.rows) {
    if (!row.dressing || !counts(row)) continue;
    const BackendLook look = look_of(folder, row.backend);
    const std::string name =
        look.name + (is_parallel(row.backend) ? ", with parallelisation" : ", without parallelisation");
    auto series = std::ranges::find(chart.series, name, &Series::name);
    if (series == chart.series.end())
      series = chart.series.insert(series, Series{.name = name, .family = look.family});
    add_time(*series, row);
  }
  return chart.series.empty() ? std::nullopt : std::optional(std::move(chart));
}

/// For each scene, the speed-up of the first integrator over the fewest threads, against threads.
std::vector<Chart> thread_charts(const ReportFolder& folder, const std::string& id) {
  std::vector<Chart> charts;
  if (!folder.provenance) return charts;
  const Provenance& provenance = *folder.provenance;
  const std::vector<const ResultRow*> pointers = pointers_to(folder.rows);
  const ResultRow* last = nullptr;
  for (const ThreadRow& of : thread_rows(pointers, provenance)) {
    const std::optional<RatioInterval> speedup = of.speedup();
    if (!speedup || of.row->integrator != folder.rows.front().integrator) continue;
    if (!last || last->scene != of.row->scene) {
      charts.push_back(
          {.id = fmt::format("{}-threads-{}", id, charts.size()),
           .title = of.row->scene + ", " + of.row->integrator + ": speed-up over the fewest threads",
           .subtitle = where_measured(provenance, false),
           .x = {.label = "threads", .logarithmic = true, .ticks_at_values = true},
           .y = {"times as fast", true},
           .series = {{.name = "linear speed-up", .origin = Origin::reference}}});
    }
    last = of.row;
    std::vector<Series>& all = charts.back().series;
    const BackendLook look = look_on(opencl_device(*of.row), of.backend, provenance);
    auto series = std::ranges::find(all, look.family, &Series::family);
    if (series == all.end()) series = all.insert(series, {.name = look.name, .family = look.family});
    if (all.size() == 2) all.front().add(of.threads, static_cast<double>(of.threads) / of.fewest_threads);
    add_ratio(*series, of.threads, *speedup);
  }
  return charts;
}

}  // namespace

BackendLook look_on(std::string_view device, std::string_view backend, const Provenance& provenance) {
  // The baseline of a page looks like the other one: they never meet in a chart.
  std::string name(backend), family(backend == browser_baseline_name ? baseline_name : backend);
  if (is_this_processor(device, provenance))
    family = name += on_the_cpu;
  else if (!device.empty())
    name += ", " + device_name(device);
  return {std::move(name), std::move(family)};
}

bool is_for_gpus(std::string_view backend, const PaperLegend& legend) {
  return legend.configuration_of(backend).find("gpu") != std::string::npos;
}

std::vector<std::string> families_of_backends(const PaperLegend& legend) {
  // Those of the paper's configurations come first, each with its row on the CPU, and leave a colour for
  // another row in their charts.
  std::vector<std::string> families, of_pages;
  for (const PaperLegend::Backend& backend : legend.backends) {
    if (backend.configuration.empty() || backend.name.find(':') != std::string::npos ||
        backend.name == browser_baseline_name)
      continue;
    std::vector<std::string>& list = is_browser_backend(backend.name) ? of_pages : families;
    list.push_back(backend.name);
    if (is_for_gpus(backend.name, legend)) list.push_back(backend.name + on_the_cpu);
  }
  families.insert(families.end(), of_pages.begin(), of_pages.end());
  return families;
}

std::string where_measured(const Provenance& provenance, bool with_threads) {
  if (provenance.machine.cpu_model.empty()) return {};
  return "Measured on " + cpu_name(provenance.machine) +
         (with_threads ? ", " + pluralize(provenance.threads, "thread") : "");
}

std::vector<Chart> history_charts(const MachineHistory& machine, const std::string& id) {
  std::vector<Chart> charts;
  for (const HistorySeries& row : machine.series) {
    const std::string title = row.scene + ", " + row.integrator + ": time per step by commit";
    auto chart = std::ranges::find(charts, title, &Chart::title);
    if (chart == charts.end()) {
      charts.push_back({.id = fmt::format("{}-{}", id, charts.size() + 1),
                        .title = title,
                        .subtitle = "Measured on " + machine.name,
                        .x = {.label = "commit, counted from 1", .ticks_at_values = true},
                        .y = {"time per step (ms)", true}});
      chart = charts.end() - 1;
    }
    const auto number = [&](std::size_t time) { return static_cast<double>(row.at[time] + 1); };
    const std::string name = name_in_chart(row, machine);
    Series times{.name = name, .family = row.backend, .low = row.low, .high = row.high};
    for (std::size_t i = 0; i < row.ms.size(); ++i) times.add(number(i), row.ms[i]);
    chart->series.push_back(std::move(times));
    if (row.changes.empty()) continue;
    Series marks{.name = name + ", change", .origin = Origin::reference, .mark = PointMark::ring};
    for (const ChangePoint& change : row.changes) marks.add(number(change.first), row.ms[change.first]);
    chart->series.push_back(std::move(marks));
  }
  return charts;
}

ContentKind kind_of(const ResultRow& row) {
  if (row.springs_published == 2 * row.springs_unique) return ContentKind::cloth;
  if (row.springs_published == 3 * row.springs_unique) return ContentKind::bodies;
  return row.dressing ? ContentKind::garment : ContentKind::other;
}

std::vector<Chart> speedup_charts(const ReportFolder& folder, const ReportInput& input,
                                  const std::string& id) {
  std::vector<Chart> charts;
  for (const PublishedTable& published : input.published)
    add_speedup_charts(charts, folder, input.legend, published,
                       id + "-" + std::string(published.info().name));
  if (auto figure6 = figure6_chart(folder, id)) charts.push_back(std::move(*figure6));
  return charts;
}

std::vector<Chart> scaling_charts(const ReportFolder& folder, const ReportInput& input,
                                  const std::string& id) {
  std::vector<Chart> charts;
  if (folder.rows.empty()) return charts;
  const std::string integrator = folder.rows.front().integrator;
  for (std::size_t kind = 0; kind < kind_names.size(); ++kind) {
    Chart chart{.id = fmt::format("{}-scaling-{}", id, kind),
                .title = fmt::format("{}: time per step of {}", integrator, kind_names[kind]),
                .subtitle = where_measured(folder.where_from()),
                .x = nodes_axis(),
                .y = {"time per step (ms)", true}};
    std::vector<std::string> shown;
    for (const std::string& backend : distinct<std::string>(folder.rows, &ResultRow::backend)) {
      SizeLines lines = size_lines(folder, input, static_cast<ContentKind>(kind), backend, integrator);
      if (!lines.measured_slope) continue;
      chart.series.push_back(with_slope(std::move(lines.measured), lines.measured_slope));
      if (lines.published.x.empty() || std::ranges::find(shown, lines.configuration) != shown.end()) continue;
      shown.push_back(lines.configuration);
      chart.series.push_back(with_slope(std::move(lines.published), lines.published_slope));
    }
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }
  std::ranges::move(thread_charts(folder, id), std::back_inserter(charts));
  return charts;
}

Table slope_table(const ReportFolder& folder, const ReportInput& input) {
  Table table;
  for (std::size_t kind = 0; kind < kind_names.size(); ++kind)
    for (const std::string& integrator : distinct<std::string>(folder.rows, &ResultRow::integrator))
      for (const std::string& backend : distinct<std::string>(folder.rows, &ResultRow::backend)) {
        const SizeLines lines =
            size_lines(folder, input, static_cast<ContentKind>(kind), backend, integrator);
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

std::optional<Chart> roofline_chart(const ReportFolder& folder, const std::string& id) {
  const ResultRow* largest = nullptr;
  for (const ResultRow& row : folder.rows)
    if (row.roofline_fraction && dot_of(row) && (!largest || row.nodes > largest->nodes)) largest = &row;
  if (!largest) return std::nullopt;
  Chart chart{.id = id + "-roofline",
              .title = "Roofline: " + largest->scene + ", " + largest->integrator,
              .subtitle = where_measured(folder.where_from()),
              .form = ChartForm::points,
              .x = {"operations per byte", true},
              .y = {"operations per second (10⁹)", true}};
  std::map<int, std::vector<RoofDot>> under_roof;  // by threads
  for (const ResultRow& row : folder.rows) {
    if (row.scene != largest->scene || row.integrator != largest->integrator) continue;
    const auto dot = dot_of(row);
    if (!dot) continue;
    const BackendLook look = look_of(folder, row.backend);
    chart.series.push_back(
        {.name = look.name, .family = look.family, .x = {dot->intensity}, .y = {dot->gigaflops}});
    if (dot->roof) under_roof[row.threads].push_back(*dot);
  }
  for (const auto& [threads, dots] : under_roof) chart.series.push_back(roof_line(threads, dots));
  return chart;
}

bool has_one_place(const Chart& chart) {
  const auto range = range_of(chart);
  return chart.form == ChartForm::lines && chart.x.ticks_at_values && range && range->x.low == range->x.high;
}

Table values_of(const Chart& chart) {
  Table table{{{chart.x.label}, {"configuration"}, {chart.y.label}, {"95 % interval", Align::right}}, {}};
  for (const Series& series : chart.series) {
    if (series.origin == Origin::reference) continue;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      // Without an interval, its ends are the value.
      const bool is_wide = !series.low.empty() && series.low[i] < series.high[i];
      table.rows.push_back({static_cast<std::uint64_t>(series.x[i]), series.name, series.y[i],
                            is_wide ? Cell(interval_text(series.low[i], series.high[i])) : Cell()});
    }
  }
  return table;
}

Chart energy_chart(const FoundCurve& curve, std::span<const FoundCurve> references, const std::string& id) {
  // More points would hide the reference.
  constexpr std::size_t most_points = 40;
  Chart chart{.id = id, .title = "Total energy: " + curve.name, .x = {"time (s)"}, .y = {"total energy (J)"}};
  Series& points = chart.series.emplace_back(Series{.name = curve.name});
  const std::size_t count = curve.time_s.size(), shown = std::min(count, most_points);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t at = shown == count ? i : i * (count - 1) / (most_points - 1);  // from first to last
    points.add(curve.time_s[at], curve.total_j[at]);
  }
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

std::vector<Chart> with_looks_of_backends(std::vector<Chart> charts, const PaperLegend& legend) {
  for (Chart& chart : charts)
    if (chart.families.empty()) chart.families = families_of_backends(legend);
  return charts;
}

}  // namespace mssim
