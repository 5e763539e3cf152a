#include "output/tables/paper_table.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "output/tables/ratio_mark.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view baseline_configuration = "cpu-only";

constexpr std::string_view how_to_read_paper_table =
    "Milliseconds per step; in brackets how many times as fast as one thread. *Published* lines are the "
    "paper's numbers, from its authors' mobile device, compared with its *CPU only*; **measured** lines are "
    "ours, medians, compared with `serial`. Springs are counted as in the paper: ";
constexpr std::string_view why_frozen =
    "The published midpoint and Runge-Kutta steps cost hardly more than an Euler step. *Inferred from those "
    "times, not stated in the paper:* they evaluated the forces once and reused them in the trial steps. "
    "`semi-euler`, `midpoint` and `rk4` evaluate the forces anew in every stage; `midpoint-frozen` and "
    "`rk4-frozen`";

struct Scene {
  std::string name;
  std::uint64_t nodes = 0, springs = 0;
};

/// The rows that belong into the table, by scene, backend and integrator.
class Measured {
 public:
  Measured(std::span<const ResultRow> rows, const PublishedTable& published) {
    for (const ResultRow& row : rows) {
      if (!published.has_scene(row.nodes, row.springs_published)) continue;
      rows_.push_back(&row);
      if (std::none_of(scenes_.begin(), scenes_.end(),
                       [&](const Scene& scene) { return scene.name == row.scene; }))
        scenes_.push_back({row.scene, row.nodes, row.springs_published.value()});
    }
    std::stable_sort(scenes_.begin(), scenes_.end(),
                     [](const Scene& a, const Scene& b) { return a.nodes < b.nodes; });
  }

  const std::vector<Scene>& scenes() const { return scenes_; }
  const std::vector<const ResultRow*>& rows() const { return rows_; }
  bool has(const std::string& integrator) const {
    return std::any_of(rows_.begin(), rows_.end(),
                       [&](const ResultRow* row) { return row->integrator == integrator; });
  }
  bool has(const std::string& integrator, const std::string& backend) const {
    return std::any_of(rows_.begin(), rows_.end(), [&](const ResultRow* row) {
      return row->integrator == integrator && row->backend == backend;
    });
  }

 private:
  std::vector<Scene> scenes_;
  std::vector<const ResultRow*> rows_;
};

/// A time, and how many times as fast as one thread that is.
struct Timing {
  std::optional<double> ms, speedup;
};

Timing published_timing(const PublishedTable& published, const PaperLegend::Integrator& integrator,
                        std::string_view configuration, const Scene& scene) {
  const auto ms = published.ms(integrator.paper_name, configuration, scene.nodes, scene.springs);
  const auto base = published.ms(integrator.paper_name, baseline_configuration, scene.nodes, scene.springs);
  return {ms, ms && base ? std::optional(*base / *ms) : std::nullopt};
}

Timing measured_timing(const ResultRow* row) {
  return row && counts(*row) ? Timing{row->ms_per_step, row->speedup_vs_serial} : Timing{};
}

Table data_of(const Measured& measured, const PaperLegend& legend, const PublishedTable& published) {
  Table table{{{"integrator"}, {"configuration"}, {"backend"}, {"quantity"}}, {}};
  std::vector<Cell> nodes{{}, {}, {}, "nodes"}, springs{{}, {}, {}, "springs_published"};
  for (const Scene& scene : measured.scenes()) {
    table.columns.push_back({scene.name});
    nodes.emplace_back(scene.nodes);
    springs.emplace_back(scene.springs);
  }
  table.rows = {std::move(nodes), std::move(springs)};
  for (const auto& integrator : legend.integrators)
    for (const auto& backend : legend.backends) {
      if (!measured.has(integrator.name, backend.name)) continue;
      const auto line = [&](std::string_view quantity, auto cell) {
        std::vector<Cell>& cells = table.rows.emplace_back();
        cells = {integrator.name, backend.configuration, backend.name, quantity};
        for (const Scene& scene : measured.scenes())
          cells.push_back(cell(scene, find_row(measured.rows(), scene.name, backend.name, integrator.name)));
      };
      const auto from_paper = [&](const Scene& scene) {
        return published_timing(published, integrator, backend.configuration, scene);
      };
      line("published_ms", [&](const Scene& scene, const ResultRow*) { return from_paper(scene).ms; });
      line("measured_ms", [](const Scene&, const ResultRow* row) { return measured_timing(row).ms; });
      line("published_speedup",
           [&](const Scene& scene, const ResultRow*) { return from_paper(scene).speedup; });
      line("measured_speedup",
           [](const Scene&, const ResultRow* row) { return measured_timing(row).speedup; });
      line("status", [](const Scene&, const ResultRow* row) { return row ? Cell(status_of(*row)) : Cell(); });
    }
  return table;
}

/// Makes the page, block by block.
class Page {
 public:
  Page(const Measured& measured, const PaperLegend& legend, const PublishedTable& published,
       const Provenance& provenance)
      : measured_(measured), legend_(legend), published_(published), provenance_(provenance) {}

  Document made() const {
    Document page{Heading{1, std::string(published_.info().title) + ", published and measured"},
                  measured_on(measured_.rows(), provenance_),
                  Paragraph{std::string(how_to_read_paper_table).append(published_.info().springs_counted) +
                            " the unique ones, by inference from its numbers."},
                  Paragraph{std::string(why_frozen) + (has_frozen() ? "" : " (`--integrator all`)") +
                            " hold them as the paper seems to, and reproduce its ratio of costs."}};
    for (const auto& integrator : legend_.integrators) {
      if (!measured_.has(integrator.name)) continue;
      const std::string evaluations =
          pluralize(static_cast<std::uint64_t>(integrator.force_evaluations), "force evaluation");
      page.insert(page.end(), {Heading{2, integrator.name + ": " + evaluations +
                                              " a step, beside the published " + integrator.paper_name},
                               times(integrator)});
    }
    const std::vector<const ResultRow*> shown = shown_rows();
    add_sentence(page, legend_of_ratios(page));
    add_sentence(page, legend_of_excess(shown, provenance_));
    add_sentence(page, reason_without_speedups(shown));
    add_rows_without_a_time(page, shown);
    return page;
  }

 private:
  bool has_frozen() const {
    return std::ranges::any_of(legend_.integrators, [&](const auto& integrator) {
      return integrator.name != integrator.paper_name && measured_.has(integrator.name);
    });
  }

  /// In the order of the tables.
  std::vector<const ResultRow*> shown_rows() const {
    std::vector<const ResultRow*> shown;
    for (const auto& integrator : legend_.integrators)
      for (const auto& backend : legend_.backends)
        for (const Scene& scene : measured_.scenes())
          if (const auto* row = find_row(measured_.rows(), scene.name, backend.name, integrator.name))
            shown.push_back(row);
    return shown;
  }

  Table times(const PaperLegend::Integrator& integrator) const {
    Table table{{{"nodes\nsprings"}}, {}};
    for (const Scene& scene : measured_.scenes())
      table.columns.push_back({grouped(scene.nodes) + '\n' + grouped(scene.springs), Align::right});
    for (const PaperConfiguration& configuration : paper_configurations) {
      bool published = false;
      for (const auto& backend : legend_.backends) {
        if (backend.configuration != configuration.name || !measured_.has(integrator.name, backend.name))
          continue;
        if (!std::exchange(published, true)) table.rows.push_back(published_line(integrator, configuration));
        table.rows.push_back(measured_line(integrator, backend));
      }
    }
    return table;
  }

  std::vector<Cell> published_line(const PaperLegend::Integrator& integrator,
                                   const PaperConfiguration& configuration) const {
    bool any = false;
    std::vector<Cell> cells{{}};
    for (const Scene& scene : measured_.scenes()) {
      const Timing timing = published_timing(published_, integrator, configuration.name, scene);
      any |= timing.ms.has_value();
      Cell& cell = cells.emplace_back(timing.ms);
      cell.exact = true;
      if (timing.speedup && configuration.name != baseline_configuration)
        cell.suffix = in_brackets(*timing.speedup);
    }
    cells.front() = std::string(configuration.caption) + ", *" + (any ? "published" : "not published") + "*";
    return cells;
  }

  std::vector<Cell> measured_line(const PaperLegend::Integrator& integrator,
                                  const PaperLegend::Backend& backend) const {
    std::vector<Cell> cells{backend_label(measured_.rows(), backend.name, provenance_) + ", **measured**"};
    for (const Scene& scene : measured_.scenes()) {
      const ResultRow* row = find_row(measured_.rows(), scene.name, backend.name, integrator.name);
      const Timing timing = measured_timing(row);
      Cell& cell = cells.emplace_back(measured_cell(row, timing.ms));
      if (!timing.ms) continue;
      cell.suffix = mark_of_excess(*row, provenance_);
      if (timing.speedup && backend.configuration != baseline_configuration)
        cell.suffix.append(in_brackets(*timing.speedup)).append(mark_of_speedup(measured_.rows(), *row));
    }
    return cells;
  }

  const Measured& measured_;
  const PaperLegend& legend_;
  const PublishedTable& published_;
  const Provenance& provenance_;
};

}  // namespace

std::optional<ResultTable> paper_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                                       const PublishedTable& published, const Provenance& provenance) {
  const Measured measured(rows, published);
  if (measured.rows().empty()) return std::nullopt;
  return ResultTable{std::string(published.info().name), data_of(measured, legend, published),
                     Page(measured, legend, published, provenance).made()};
}

TableMaker paper_tables(PaperLegend legend, std::vector<PublishedTable> published) {
  return [legend = std::move(legend), published = std::move(published)](std::span<const ResultRow> rows,
                                                                        const Provenance& provenance) {
    std::vector<ResultTable> tables;
    for (const PublishedTable& each : published)
      if (auto table = paper_table(rows, legend, each, provenance)) tables.push_back(std::move(*table));
    return tables;
  };
}

}  // namespace mssim
