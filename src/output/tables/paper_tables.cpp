#include <algorithm>

#include "output/tables/suite_tables.h"
#include "platform/files.h"
#include "text/text.h"

namespace mssim {

PublishedTable::PublishedTable(const PublishedTableInfo& table_info)
    : PublishedTable(table_info, CsvTable(data_folder() / "published" /
                                          ("hong2016_" + std::string(table_info.name) + ".csv"))) {}

PublishedTable::PublishedTable(const PublishedTableInfo& table_info, const CsvTable& table)
    : info_(table_info) {
  // Table 3 calls its fourth column springs_published, because its counts are not numbers of springs.
  const bool counts_apart = table.header().size() > 3 && table.header()[3] == "springs_published";
  table.require_columns({"integrator", "configuration", "nodes",
                         counts_apart ? "springs_published" : "springs", "ms_per_step"});
  for (std::size_t record = 0; record < table.size(); ++record)
    times_.push_back({table.text(record, 0), table.text(record, 1), table.count(record, 2),
                      table.count(record, 3), table.number(record, 4)});
}

std::optional<double> PublishedTable::ms(std::string_view integrator, std::string_view configuration,
                                         std::uint64_t nodes,
                                         std::optional<std::uint64_t> springs_published) const {
  const auto time = std::find_if(times_.begin(), times_.end(), [&](const Time& candidate) {
    return candidate.integrator == integrator && candidate.configuration == configuration &&
           candidate.nodes == nodes && candidate.springs == springs_published;
  });
  if (time == times_.end()) return std::nullopt;
  return time->ms;
}

bool PublishedTable::has_scene(std::uint64_t nodes, std::optional<std::uint64_t> springs_published) const {
  return std::any_of(times_.begin(), times_.end(), [&](const Time& time) {
    return time.nodes == nodes && time.springs == springs_published;
  });
}

std::optional<double> PublishedTable::speedup(std::string_view integrator, std::string_view configuration,
                                              const PaperScene& scene) const {
  const auto its_ms = ms(integrator, configuration, scene.nodes, scene.springs);
  const auto base = ms(integrator, one_thread_configuration, scene.nodes, scene.springs);
  return its_ms && base ? std::optional(*base / *its_ms) : std::nullopt;
}

std::vector<PaperScene> PublishedTable::scenes() const {
  std::vector<PaperScene> scenes;
  for (const Time& time : times_)
    if (std::ranges::find(scenes, time.nodes, &PaperScene::nodes) == scenes.end())
      scenes.push_back({{}, time.nodes, time.springs});
  return scenes;
}

std::vector<PaperScene> PublishedTable::scenes_of(std::span<const ResultRow> rows) const {
  std::vector<PaperScene> scenes;
  for (const ResultRow& row : rows)
    if (row.scene_as_shipped && has_scene(row.nodes, row.springs_published) &&
        std::ranges::find(scenes, row.scene, &PaperScene::name) == scenes.end())
      scenes.push_back({row.scene, row.nodes, row.springs_published.value()});
  std::ranges::stable_sort(scenes, {}, &PaperScene::nodes);
  return scenes;
}

std::vector<PublishedTable> published_tables() {
  return {published_table_kinds.begin(), published_table_kinds.end()};
}

std::vector<PublishedBody> published_bodies() {
  return published_bodies(CsvTable(data_folder() / "published/hong2016_table2.csv"));
}

std::vector<PublishedBody> published_bodies(const CsvTable& table) {
  table.require_columns({"object", "size", "nodes", "springs_published"});
  std::vector<PublishedBody> bodies;
  for (std::size_t record = 0; record < table.size(); ++record)
    bodies.push_back(
        {table.text(record, 0), table.text(record, 1), table.count(record, 2), table.count(record, 3)});
  return bodies;
}

namespace {

constexpr std::string_view how_to_read_paper_table =
    "Milliseconds per step; in brackets how many times as fast as one thread. *Published* lines are the "
    "paper's numbers (2016), from the CPU and the mobile GPU of a Nexus 7 tablet; its Figure 5 shows ten "
    "threads. They are compared with its *CPU only*. **Measured** lines are ours, medians from the processor "
    "and devices named above, compared with ";
constexpr std::string_view how_springs_count = "Springs are counted as in the paper: ";
/// For tables with such rows.
constexpr std::string_view how_to_read_each =
    "Lines with `:each` step one body after the other, as the paper does; all others step all bodies "
    "together, which the paper names as future work. ";
constexpr std::string_view which_methods =
    "`semi-euler`, `midpoint` and `rk4` are the textbook methods that Eqs. (2) to (4) of the paper name, and "
    "evaluate the forces again in every stage; `midpoint-frozen` and `rk4-frozen`";

/// A time, and its speed-up over one thread.
struct Timing {
  std::optional<double> ms, speedup;
};

Timing published_timing(const PublishedTable& published, const PaperLegend::Integrator& integrator,
                        std::string_view configuration, const PaperScene& scene) {
  return {published.ms(integrator.paper_name, configuration, scene.nodes, scene.springs),
          published.speedup(integrator.paper_name, configuration, scene)};
}

Timing measured_timing(const ResultRow* row) {
  return row && counts(*row) ? Timing{row->ms_per_step, row->speedup_vs_serial} : Timing{};
}

/// One of the published tables, with its measurements.
class PaperTable {
 public:
  PaperTable(std::span<const ResultRow> rows, const PaperLegend& legend, const PublishedTable& published,
             const Provenance& provenance)
      : scenes_(published.scenes_of(rows)), legend_(legend), published_(published), provenance_(provenance) {
    for (const ResultRow& row : rows)
      if (row.scene_as_shipped && published.has_scene(row.nodes, row.springs_published))
        rows_.push_back(&row);
  }

  bool empty() const { return rows_.empty(); }

  Table data() const {
    Table table{{{"integrator"}, {"configuration"}, {"backend"}, {"quantity"}}, {}};
    std::vector<Cell> nodes{{}, {}, {}, "nodes"}, springs{{}, {}, {}, "springs_published"};
    for (const PaperScene& scene : scenes_) {
      table.columns.push_back({scene.name});
      nodes.emplace_back(scene.nodes);
      springs.emplace_back(scene.springs);
    }
    table.rows = {std::move(nodes), std::move(springs)};
    for (const auto& integrator : legend_.integrators)
      for (const auto& backend : legend_.backends) {
        if (!has(integrator.name, backend.name)) continue;
        const std::size_t first = table.rows.size();
        for (const char* quantity :
             {"published_ms", "measured_ms", "published_speedup", "measured_speedup", "status"})
          table.rows.push_back({integrator.name, backend.configuration, backend.name, quantity});
        for (const PaperScene& scene : scenes_) {
          const ResultRow* row = find_row(rows_, scene.name, backend.name, integrator.name);
          const Timing paper = published_timing(published_, integrator, backend.configuration, scene),
                       ours = measured_timing(row);
          const std::array<Cell, 5> cells{paper.ms, ours.ms, paper.speedup, ours.speedup,
                                          row ? Cell(status_of(*row)) : Cell()};
          for (std::size_t i = 0; i < cells.size(); ++i) table.rows[first + i].push_back(cells[i]);
        }
      }
    return table;
  }

  Document page() const {
    Document text{
        Heading{1, std::string(published_.info().title) + ", published and measured"},
        measured_on(rows_, provenance_),
        Paragraph{fmt::format("{}`{}`. {}{}{} the unique ones, by inference from its numbers.",
                              how_to_read_paper_table, baseline(), has_each() ? how_to_read_each : "",
                              how_springs_count, published_.info().springs_counted)},
        Paragraph{std::string(which_methods) + (has_frozen() ? "" : " (`--integrator all`)") +
                  ", which the paper does not have, evaluate them once per step."}};
    for (const auto& integrator : legend_.integrators) {
      if (!has(integrator.name)) continue;
      const std::string evaluations = pluralize(integrator.force_evaluations, "force evaluation");
      text.insert(text.end(), {Heading{2, fmt::format("{}: {} per step, compared with the published {}",
                                                      integrator.name, evaluations, integrator.paper_name)},
                               times(integrator)});
    }
    const std::vector<const ResultRow*> shown = shown_rows();
    add_sentence(text, legend_of_ratios(text));
    add_sentence(text, legend_of_excess(shown, provenance_));
    add_sentence(text, reason_without_speedups(shown));
    add_rows_without_a_time(text, shown);
    return text;
  }

 private:
  bool has(const std::string& integrator) const {
    return std::ranges::find(rows_, integrator, &ResultRow::integrator) != rows_.end();
  }
  bool has(const std::string& integrator, const std::string& backend) const {
    return std::ranges::any_of(rows_, [&](const ResultRow* row) {
      return row->integrator == integrator && row->backend == backend;
    });
  }
  bool has_each() const {
    return std::ranges::any_of(
        rows_, [](const ResultRow* row) { return row->backend.find(each_suffix) != std::string::npos; });
  }
  bool has_frozen() const {
    return std::ranges::any_of(legend_.integrators, [&](const auto& integrator) {
      return integrator.name != integrator.paper_name && has(integrator.name);
    });
  }

  /// The backend that the measured times are compared with.
  std::string_view baseline() const {
    const auto row = std::ranges::find_if(rows_, is_baseline, &ResultRow::backend);
    return row == rows_.end() ? baseline_name : std::string_view((*row)->backend);
  }

  /// The rows that are shown, in the order of the tables.
  std::vector<const ResultRow*> shown_rows() const {
    std::vector<const ResultRow*> shown;
    for (const auto& integrator : legend_.integrators)
      for (const auto& backend : legend_.backends)
        for (const PaperScene& scene : scenes_)
          if (const auto* row = find_row(rows_, scene.name, backend.name, integrator.name))
            shown.push_back(row);
    return shown;
  }

  Table times(const PaperLegend::Integrator& integrator) const {
    Table table{{{"nodes\nsprings"}}, {}};
    for (const PaperScene& scene : scenes_)
      table.columns.push_back({grouped(scene.nodes) + '\n' + grouped(scene.springs), Align::right});
    for (const PaperConfiguration& configuration : paper_configurations) {
      bool published = false;
      for (const auto& backend : legend_.backends) {
        if (backend.configuration != configuration.name || !has(integrator.name, backend.name)) continue;
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
    for (const PaperScene& scene : scenes_) {
      const Timing timing = published_timing(published_, integrator, configuration.name, scene);
      any |= timing.ms.has_value();
      Cell& cell = cells.emplace_back(timing.ms);
      cell.exact = true;
      if (timing.speedup && configuration.name != one_thread_configuration)
        cell.suffix = in_brackets(*timing.speedup);
    }
    cells.front() = std::string(configuration.caption) + ", *" + (any ? "published" : "not published") + "*";
    return cells;
  }

  std::vector<Cell> measured_line(const PaperLegend::Integrator& integrator,
                                  const PaperLegend::Backend& backend) const {
    std::vector<Cell> cells{backend_label(rows_, backend.name, provenance_) + ", **measured**"};
    for (const PaperScene& scene : scenes_) {
      const ResultRow* row = find_row(rows_, scene.name, backend.name, integrator.name);
      const Timing timing = measured_timing(row);
      Cell& cell = cells.emplace_back(measured_cell(row, timing.ms));
      if (!timing.ms) continue;
      cell.suffix = mark_of_excess(*row, provenance_);
      if (timing.speedup && !is_baseline(backend.name))
        cell.suffix.append(in_brackets(*timing.speedup)).append(mark_of_speedup(rows_, *row));
    }
    return cells;
  }

  std::vector<const ResultRow*> rows_;  ///< those that belong in the table
  std::vector<PaperScene> scenes_;
  const PaperLegend& legend_;
  const PublishedTable& published_;
  const Provenance& provenance_;
};

constexpr std::string_view how_to_read_structure =
    "Nodes and springs are counted from the tetrahedra of the scene's mesh. The published counts "
    "of springs are three times the unique edges, by inference: all nine can be divided by three, a third of "
    "each fits a tetrahedral mesh of that many nodes, and the packed unit of the paper's Figure 6 holds "
    "three values for each spring. Inner points and surfaces were chosen so that TetGen meets both published "
    "numbers; the paper shows neither its surfaces nor its switches.";

/// The paper's body of the scene; null if it has none.
const PublishedBody* body_of(const StructureRow& row, const std::vector<PublishedBody>& bodies) {
  return found_in(bodies, row.scene, &PublishedBody::scene);
}

bool are_same(const StructureRow& row, const PublishedBody& body) {
  return row.nodes == body.nodes && row.springs_published == body.springs;
}

Table data_of(std::span<const StructureRow> rows, const std::vector<PublishedBody>& bodies) {
  Table table = structure_rows(rows);
  for (const std::string_view name : {"paper_nodes", "paper_springs", "same_as_paper"})
    table.columns.push_back({std::string(name)});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PublishedBody* body = body_of(rows[i], bodies);
    const auto cells = body ? std::array<Cell, 3>{body->nodes, body->springs, are_same(rows[i], *body)}
                            : std::array<Cell, 3>();
    table.rows[i].insert(table.rows[i].end(), cells.begin(), cells.end());
  }
  return table;
}

Cell strong(Cell cell) {
  cell.strong = true;
  return cell;
}

Document page_of(std::span<const StructureRow> rows, const std::vector<PublishedBody>& bodies,
                 const Provenance& provenance) {
  Table table{{{"body", Align::left},
               {"size", Align::left},
               {"nodes, *published*", Align::right},
               {"nodes", Align::right},
               {"springs, *published*", Align::right},
               {"springs x 3", Align::right},
               {"unique springs", Align::right},
               {"tetrahedra", Align::right},
               {"smallest dihedral angle", Align::right, "°"},
               {"same", Align::left}},
              {}};
  for (const StructureRow& row : rows)
    if (const PublishedBody* body = body_of(row, bodies))
      table.rows.push_back({body->object, body->size, body->nodes, strong(row.nodes), body->springs,
                            strong(row.springs_published), row.springs_unique, row.tetrahedra,
                            row.smallest_dihedral_angle_deg,
                            are_same(row, *body) ? Cell(true) : strong(false)});
  return {Heading{1, "Bodies: Table 2 of Hong et al. (2016), published and built"},
          Paragraph{made_by(provenance) + "."}, Paragraph{std::string(how_to_read_structure)},
          std::move(table)};
}

}  // namespace

TableMaker paper_tables(PaperLegend legend, std::vector<PublishedTable> published) {
  return [legend = std::move(legend), published = std::move(published)](std::span<const ResultRow> rows,
                                                                        const Provenance& provenance) {
    std::vector<ResultTable> tables;
    for (const PublishedTable& each : published)
      if (const PaperTable table(rows, legend, each, provenance); !table.empty())
        tables.push_back({each.info().name, table.data(), table.page()});
    return tables;
  };
}

Table structure_rows(std::span<const StructureRow> rows) {
  Table table;
  for (const StructureRow& row : rows)
    table.add({{"scene", row.scene},
               {"nodes", row.nodes},
               {"springs_unique", row.springs_unique},
               {"springs_published", row.springs_published},
               {"tetrahedra", row.tetrahedra},
               {"smallest_dihedral_angle_deg", row.smallest_dihedral_angle_deg}});
  return table;
}

std::vector<StructureRow> read_structure(const CsvTable& table) {
  std::vector<StructureRow> rows;
  const auto at = [&](std::string_view name) { return table.column(name); };
  for (std::size_t record = 0; record < table.size(); ++record)
    rows.push_back({table.text(record, at("scene")), table.count(record, at("nodes")),
                    table.count(record, at("springs_unique")), table.count(record, at("springs_published")),
                    table.count(record, at("tetrahedra")),
                    table.number(record, at("smallest_dihedral_angle_deg"))});
  return rows;
}

ResultTable structure_table(std::span<const StructureRow> rows, const Provenance& provenance) {
  const std::vector<PublishedBody> bodies = published_bodies();
  return {"table2", data_of(rows, bodies), page_of(rows, bodies, provenance)};
}

}  // namespace mssim
