#include <algorithm>
#include <array>

#include "report/report_charts.h"
#include "report/times_as_fast.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::array<ContentKind, 4> scene_kinds{ContentKind::cloth, ContentKind::bodies,
                                                 ContentKind::garment, ContentKind::other};

/// The rows of one kind, backend and integrator that count, by size.
std::vector<const ResultRow*> rows_by_size(std::span<const ResultRow> rows, ContentKind kind,
                                           std::string_view backend, std::string_view integrator) {
  std::vector<const ResultRow*> list;
  for (const ResultRow& row : rows)
    if (kind_of(row) == kind && row.backend == backend && row.integrator == integrator && counts(row))
      list.push_back(&row);
  std::ranges::stable_sort(list, {}, [](const ResultRow* row) { return row->nodes; });
  return list;
}

/// Values of the rows, in the order in which they appear, each once.
std::vector<std::string> distinct(std::span<const ResultRow> rows, std::string ResultRow::*value) {
  std::vector<std::string> values;
  for (const ResultRow& row : rows)
    if (std::ranges::find(values, row.*value) == values.end()) values.push_back(row.*value);
  return values;
}

std::string with_slope(const std::string& name, const Series& series) {
  const auto slope = exponent_of(series.x, series.y);
  return slope ? name + ", slope " + fixed_decimal(*slope, 2) : name;
}

Series measured_line(const std::vector<const ResultRow*>& list, const std::string& family) {
  Series series{"", Origin::measured, family, {}, {}, {}, {}};
  for (const ResultRow* row : list) {
    series.x.push_back(static_cast<double>(row->nodes));
    series.y.push_back(*row->ms_per_step);
    series.low.push_back(row->ms_per_step_low.value_or(*row->ms_per_step));
    series.high.push_back(row->ms_per_step_high.value_or(*row->ms_per_step));
  }
  return series;
}

/// The published times of the scenes of these rows.
Series published_line(const std::vector<const ResultRow*>& list, std::span<const PublishedTable> published,
                      std::string_view integrator, const std::string& configuration,
                      const std::string& family = {}) {
  Series series{"", Origin::published, family, {}, {}, {}, {}};
  for (const ResultRow* row : list)
    for (const PublishedTable& table : published)
      if (const auto ms = table.ms(integrator, configuration, row->nodes, row->springs_published)) {
        series.x.push_back(static_cast<double>(row->nodes));
        series.y.push_back(*ms);
      }
  return series;
}

std::string configuration_of(const PaperLegend& legend, const std::string& backend) {
  const auto found = std::ranges::find(legend.backends, backend, &PaperLegend::Backend::name);
  return found == legend.backends.end() ? std::string() : found->configuration;
}

std::string paper_name_of(const PaperLegend& legend, const std::string& integrator) {
  const auto found = std::ranges::find(legend.integrators, integrator, &PaperLegend::Integrator::name);
  return found == legend.integrators.end() ? std::string() : found->paper_name;
}

}  // namespace

ContentKind kind_of(const ResultRow& row) {
  if (row.springs_published == 2 * row.springs_unique) return ContentKind::cloth;
  if (row.springs_published == 3 * row.springs_unique) return ContentKind::bodies;
  return row.dressing ? ContentKind::garment : ContentKind::other;
}

std::string_view name_of(ContentKind kind) {
  constexpr std::array<std::string_view, 4> names{"cloths", "bodies", "garments", "other scenes"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<Chart> scaling_charts(std::span<const ResultRow> rows, const PaperLegend& legend,
                                  std::span<const PublishedTable> published, const std::string& id) {
  std::vector<Chart> charts;
  if (rows.empty()) return charts;
  const std::string integrator = rows.front().integrator;
  for (const ContentKind kind : scene_kinds) {
    Chart chart;
    chart.id = id + "-scaling-" + std::to_string(static_cast<int>(kind));
    chart.title = "Time of a " + integrator + " step of " + std::string(name_of(kind));
    chart.x = {"nodes", true};
    chart.y = {"time of a step (ms)", true};
    chart.families = backend_families;
    std::vector<std::string> shown;
    for (const std::string& backend : distinct(rows, &ResultRow::backend)) {
      const auto list = rows_by_size(rows, kind, backend, integrator);
      const std::string configuration = configuration_of(legend, backend);
      Series measured = measured_line(list, backend);
      if (!exponent_of(measured.x, measured.y)) continue;
      measured.name = with_slope(backend + ", measured", measured);
      chart.series.push_back(std::move(measured));
      if (configuration.empty() || std::ranges::find(shown, configuration) != shown.end()) continue;
      shown.push_back(configuration);
      Series line =
          published_line(list, published, paper_name_of(legend, integrator), configuration, backend);
      if (line.x.empty()) continue;
      line.name = with_slope(std::string(caption_of(configuration)) + ", published", line);
      chart.series.push_back(std::move(line));
    }
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

Table slope_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                  std::span<const PublishedTable> published) {
  Table table;
  for (const ContentKind kind : scene_kinds)
    for (const std::string& integrator : distinct(rows, &ResultRow::integrator))
      for (const std::string& backend : distinct(rows, &ResultRow::backend)) {
        const auto list = rows_by_size(rows, kind, backend, integrator);
        const Series measured = measured_line(list, "");
        const auto slope = exponent_of(measured.x, measured.y);
        if (!slope) continue;
        const std::string configuration = configuration_of(legend, backend);
        const Series line = published_line(list, published, paper_name_of(legend, integrator), configuration);
        table.add({{"backend", "`" + backend + "`"},
                   {"integrator", integrator},
                   {"scenes", std::string(name_of(kind)) + ", " + grouped(list.front()->nodes) + " to " +
                                  grouped(list.back()->nodes) + " nodes"},
                   {"measured slope", *slope},
                   {"published slope", exponent_of(line.x, line.y)}});
      }
  return table;
}

}  // namespace mssim
