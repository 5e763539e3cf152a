#include "output/tables/paper_table.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "output/tables/csv.h"
#include "output/tables/markdown.h"

namespace mssim {
namespace {

constexpr std::string_view nothing = "–";
constexpr std::string_view baseline_configuration = "cpu-only";

constexpr std::string_view how_to_read =
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
  const ResultRow* find(const std::string& scene, const std::string& backend,
                        const std::string& integrator) const {
    const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const ResultRow* candidate) {
      return candidate->scene == scene && candidate->backend == backend &&
             candidate->integrator == integrator;
    });
    return row == rows_.end() ? nullptr : *row;
  }
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

std::string table_csv(const Measured& measured, const PaperLegend& legend, const PublishedTable& published) {
  std::vector<std::string> header{"integrator", "configuration", "backend", "quantity"};
  std::vector<std::string> nodes{"", "", "", "nodes"}, springs{"", "", "", "springs_published"};
  for (const Scene& scene : measured.scenes()) {
    header.push_back(scene.name);
    nodes.push_back(std::to_string(scene.nodes));
    springs.push_back(std::to_string(scene.springs));
  }
  std::string csv = csv_line(header) + csv_line(nodes) + csv_line(springs);
  for (const auto& integrator : legend.integrators)
    for (const auto& backend : legend.backends) {
      if (!measured.has(integrator.name, backend.name)) continue;
      const auto line = [&](std::string_view quantity, auto cell) {
        std::vector<std::string> fields{integrator.name, backend.configuration, backend.name,
                                        std::string(quantity)};
        for (const Scene& scene : measured.scenes())
          fields.push_back(cell(scene, measured.find(scene.name, backend.name, integrator.name)));
        csv += csv_line(fields);
      };
      const auto from_paper = [&](const Scene& scene) {
        return published_timing(published, integrator, backend.configuration, scene);
      };
      line("published_ms",
           [&](const Scene& scene, const ResultRow*) { return csv_number(from_paper(scene).ms); });
      line("measured_ms",
           [](const Scene&, const ResultRow* row) { return csv_number(measured_timing(row).ms); });
      line("published_speedup",
           [&](const Scene& scene, const ResultRow*) { return csv_number(from_paper(scene).speedup); });
      line("measured_speedup",
           [](const Scene&, const ResultRow* row) { return csv_number(measured_timing(row).speedup); });
      line("status",
           [](const Scene&, const ResultRow* row) { return row ? status_of(*row) : std::string(); });
    }
  return csv;
}

/// Empty for the configuration that the speed-ups are measured against.
std::string speedup_suffix(const Timing& timing, std::string_view configuration) {
  if (!timing.speedup || configuration == baseline_configuration) return {};
  return std::string(" (").append(three_digits(*timing.speedup)).append("×)");
}

class Markdown {
 public:
  Markdown(const Measured& measured, const PaperLegend& legend, const PublishedTable& published)
      : measured_(measured), legend_(legend), published_(published) {}

  std::string text(const Provenance& provenance) {
    threads_ = provenance.threads;
    out_ << "# " << published_.info().title << ", published and measured\n\n"
         << measured_on(measured_.rows(), provenance);
    add_legend();
    for (const auto& integrator : legend_.integrators)
      if (measured_.has(integrator.name)) add_block(integrator);
    out_ << paragraph(legend_of_excess(shown_, threads_)) << paragraph(reason_without_speedups(shown_))
         << rows_without_a_time(shown_);
    return out_.str();
  }

 private:
  void add_legend() {
    const bool has_frozen =
        std::any_of(legend_.integrators.begin(), legend_.integrators.end(),
                    [&](const auto& row) { return row.name != row.paper_name && measured_.has(row.name); });
    out_ << how_to_read << published_.info().springs_counted
         << " the unique ones, by inference from its numbers.\n\n"
         << why_frozen << (has_frozen ? "" : " (`--integrator all`)")
         << " hold them as the paper seems to, and reproduce its ratio of costs.\n";
  }

  void add_block(const PaperLegend::Integrator& integrator) {
    out_ << "\n## " << integrator.name << ": " << integrator.force_evaluations << " force evaluation"
         << (integrator.force_evaluations == 1 ? "" : "s") << " a step, beside the published "
         << integrator.paper_name << "\n\n| nodes<br>springs |";
    for (const Scene& scene : measured_.scenes())
      out_ << " " << grouped(scene.nodes) << "<br>" << grouped(scene.springs) << " |";
    out_ << "\n|---|";
    for (std::size_t i = 0; i < measured_.scenes().size(); ++i) out_ << "---:|";
    out_ << "\n";
    for (const PaperConfiguration& configuration : paper_configurations) {
      bool published = false;
      for (const auto& backend : legend_.backends) {
        if (backend.configuration != configuration.name || !measured_.has(integrator.name, backend.name))
          continue;
        if (!std::exchange(published, true)) add_published_line(integrator, configuration);
        add_measured_line(integrator, backend);
      }
    }
  }

  void add_published_line(const PaperLegend::Integrator& integrator,
                          const PaperConfiguration& configuration) {
    bool any = false;
    std::vector<std::string> cells;
    for (const Scene& scene : measured_.scenes()) {
      const Timing timing = published_timing(published_, integrator, configuration.name, scene);
      any |= timing.ms.has_value();
      cells.emplace_back(nothing);
      if (timing.ms) cells.back() = csv_number(*timing.ms) + speedup_suffix(timing, configuration.name);
    }
    out_ << "| " << configuration.caption << ", *" << (any ? "published" : "not published") << "* |";
    for (const std::string& cell : cells) out_ << " " << cell << " |";
    out_ << "\n";
  }

  void add_measured_line(const PaperLegend::Integrator& integrator, const PaperLegend::Backend& backend) {
    out_ << "| `" << backend.name << "`, **measured** |";
    for (const Scene& scene : measured_.scenes()) {
      const ResultRow* row = measured_.find(scene.name, backend.name, integrator.name);
      if (row) shown_.push_back(row);
      if (const Timing timing = measured_timing(row); timing.ms) {
        out_ << " **" << three_digits(*timing.ms) << "**" << mark_of_excess(*row, threads_)
             << speedup_suffix(timing, backend.configuration);
      } else if (row) {
        const std::string status = status_of(*row);
        out_ << " " << one_cell(status.substr(0, status.find(':')));
      } else {
        out_ << " " << nothing;
      }
      out_ << " |";
    }
    out_ << "\n";
  }

  const Measured& measured_;
  const PaperLegend& legend_;
  const PublishedTable& published_;
  std::ostringstream out_;
  std::vector<const ResultRow*> shown_;
  int threads_ = 0;  // asked for
};

}  // namespace

PaperTable paper_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                       const PublishedTable& published, const Provenance& provenance) {
  const Measured measured(rows, published);
  if (measured.rows().empty()) return {};
  return {false, table_csv(measured, legend, published),
          Markdown(measured, legend, published).text(provenance)};
}

TableMaker paper_tables(PaperLegend legend, std::vector<PublishedTable> published) {
  return [legend = std::move(legend), published = std::move(published)](std::span<const ResultRow> rows,
                                                                        const Provenance& provenance) {
    std::vector<ResultTable> tables;
    for (const PublishedTable& each : published)
      if (PaperTable table = paper_table(rows, legend, each, provenance); !table.empty)
        tables.push_back({std::string(each.info().name), std::move(table.csv), std::move(table.markdown)});
    return tables;
  };
}

}  // namespace mssim
