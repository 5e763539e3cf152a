#include "garment/output/garment_table.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "garment/output/dressed_rows.h"
#include "output/tables/csv.h"
#include "output/tables/markdown.h"

namespace mssim {
namespace {

constexpr std::string_view nothing = "–";

using Rows = std::vector<const ResultRow*>;
/// A line of a table: a backend with an integrator.
using Line = std::pair<std::string, std::string>;

/// The rows laid out: scenes are columns, by their number of vertices, and combinations that have a time or a
/// dressing anywhere are lines.
class Layout {
 public:
  explicit Layout(Rows rows) : rows_(std::move(rows)) {
    for (const ResultRow* row : rows_) {
      if (std::ranges::find(scenes_, row->scene, &ResultRow::scene) == scenes_.end()) scenes_.push_back(row);
      const Line line(row->backend, row->integrator);
      if (row->dressing && std::ranges::find(lines_, line) == lines_.end()) lines_.push_back(line);
    }
    std::ranges::stable_sort(scenes_, {}, &ResultRow::nodes);
  }

  const Rows& rows() const { return rows_; }
  const Rows& scenes() const { return scenes_; }
  const std::vector<Line>& lines() const { return lines_; }
  const ResultRow* find(const ResultRow& scene, const Line& line) const {
    const auto row = std::ranges::find_if(rows_, [&](const ResultRow* candidate) {
      return candidate->scene == scene.scene && Line(candidate->backend, candidate->integrator) == line;
    });
    return row == rows_.end() ? nullptr : *row;
  }

 private:
  Rows rows_;
  Rows scenes_;  ///< the first row of each
  std::vector<Line> lines_;
};

bool is_baseline(const Line& line) { return line.first == "serial"; }

/// A cell of the table of times.
std::string time_cell(const ResultRow& row) {
  if (!counts(row) || !row.ms_per_step) {
    const std::string status = status_of(row);
    return one_cell(status.substr(0, status.find(':')));
  }
  std::string cell = "**" + three_digits(*row.ms_per_step) + "**";
  if (row.speedup_vs_serial && row.backend != "serial")
    cell += " (" + three_digits(*row.speedup_vs_serial) + "×)";
  return cell;
}

std::string vertex_cell(const ResultRow& row) {
  const auto ns = ns_per_vertex(row);
  return ns ? three_digits(*ns) : std::string(nothing);
}

std::string dressing_cell(const ResultRow& row) {
  if (!row.dressing) return std::string(nothing);
  return three_digits(row.dressing->wall_s) + " s<br>" + grouped(row.dressing->iterations);
}

class Markdown {
 public:
  explicit Markdown(const Layout& layout) : layout_(layout) {}

  std::string text(const Provenance& provenance) {
    threads_ = provenance.threads;
    out_ << "# Figure 6 of Vassilev: milliseconds an iteration against vertices of jeans\n\n"
         << measured_on(layout_.rows(), provenance)
         << "One iteration of Algorithm 1, medians, of jeans that hang draped on the body: springs, joints, "
            "collision with the body and the correction of velocities are at work. In brackets how many "
            "times as fast as without parallelisation. The paper shows its own times as curves, without "
            "numbers, from other machines.\n\n";
    add_table("milliseconds an iteration", time_cell);
    out_ << "\nNanoseconds an iteration and vertex, of the same samples:\n\n";
    add_table("nanoseconds", vertex_cell);
    out_ << "\nThe whole dressing, once: seconds and iterations from flat panels to jeans that hang settled. "
            "`garment.csv` says how each fits.\n\n";
    add_table("dressing", dressing_cell);
    out_ << paragraph(legend_of_excess(layout_.rows(), threads_))
         << paragraph(reason_without_speedups(layout_.rows())) << rows_without_a_time(layout_.rows());
    return out_.str();
  }

 private:
  void add_table(std::string_view title, std::string (*cell)(const ResultRow& row)) {
    out_ << "| " << title << " |";
    for (const ResultRow* scene : layout_.scenes())
      out_ << " " << scene->scene << "<br>" << grouped(scene->nodes) << " |";
    out_ << "\n|---|";
    for (std::size_t i = 0; i < layout_.scenes().size(); ++i) out_ << "---:|";
    out_ << "\n";
    for (const Line& line : layout_.lines()) {
      out_ << "| " << (is_baseline(line) ? "without: " : "with: ") << "`" << line.first << "` |";
      for (const ResultRow* scene : layout_.scenes()) {
        const ResultRow* row = layout_.find(*scene, line);
        out_ << " " << (row ? cell(*row) : std::string(nothing))
             << (row ? mark_of_excess(*row, threads_) : "") << " |";
      }
      out_ << "\n";
    }
  }

  const Layout& layout_;
  std::ostringstream out_;
  int threads_ = 0;  ///< asked for
};

std::string as_csv(const Layout& layout) {
  std::vector<std::string> fields{"backend", "integrator", "parallel", "quantity"};
  std::vector<std::string> vertices{"", "", "", "vertices"};
  for (const ResultRow* scene : layout.scenes()) {
    fields.push_back(scene->scene);
    vertices.push_back(std::to_string(scene->nodes));
  }
  std::string csv = csv_line(fields) + csv_line(vertices);
  for (const Line& line : layout.lines()) {
    const auto add = [&](const std::string& quantity, auto&& value) {
      fields = {line.first, line.second, is_baseline(line) ? "without" : "with", quantity};
      for (const ResultRow* scene : layout.scenes()) {
        const ResultRow* row = layout.find(*scene, line);
        fields.push_back(row ? csv_number(value(*row)) : "");
      }
      csv += csv_line(fields);
    };
    using Number = std::optional<double>;
    add("ms_per_iteration", [](const ResultRow& row) { return counts(row) ? row.ms_per_step : Number(); });
    add("speedup_vs_serial",
        [](const ResultRow& row) { return counts(row) ? row.speedup_vs_serial : Number(); });
    add("ns_per_iteration_and_vertex", ns_per_vertex);
    add("dressing_s",
        [](const ResultRow& row) { return row.dressing ? Number(row.dressing->wall_s) : Number(); });
    add("dressing_iterations", [](const ResultRow& row) {
      return row.dressing ? Number(static_cast<double>(row.dressing->iterations)) : Number();
    });
  }
  return csv;
}

}  // namespace

TableMaker garment_tables() {
  return [](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    Rows dressed = rows_of_dressed_scenes(rows);
    if (dressed.empty()) return tables;
    const Layout layout(std::move(dressed));
    tables.push_back({"figure6", as_csv(layout), Markdown(layout).text(provenance)});
    return tables;
  };
}

}  // namespace mssim
