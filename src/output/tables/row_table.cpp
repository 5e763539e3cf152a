#include <climits>
#include <utility>

#include "output/tables/results.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Text styles as codes of ECMA-48; each colour only repeats a sign.
constexpr std::string_view bold = "1", dim = "2", red = "31", green = "32";

struct RowCell {
  std::string text;
  std::string_view style = {};
  std::string_view mark = {};  ///< after the text, whose position it does not change
};

/// The columns, in their order.
struct Shown {
  enum : std::size_t {
    integrator,
    backend,
    threads,
    ms,
    interval,
    published,
    roofline,
    error,
    verified,
    speedup,
    count
  };
};
using RowCells = std::array<RowCell, Shown::count>;

constexpr std::array<std::string_view, Shown::count> row_headers{
    "integrator", "backend",  "threads", "ms/step",  "interval",
    "published",  "roofline", "error",   "verified", "speed-up"};
constexpr std::string_view gap = "  ";

bool is_flush_right(std::size_t column) { return column >= Shown::threads && column <= Shown::error; }

bool cannot_run(const ResultRow& row) { return row.status.starts_with("un"); }  // unsupported, unavailable

RowCell verified_cell(const ResultRow& row, bool utf8) {
  if (cannot_run(row)) return {"-", dim};
  if (row.verified) return {utf8 ? "✓" : "yes", green};
  return {utf8 ? "✗" : "NO", red};
}

/// The first word of the reason if the row has no speed-up because it does not count.
RowCell speedup_cell(RowPointers rows, const ResultRow& row, bool utf8) {
  const std::string status = status_of(row);
  if (!counts(row)) return {status.substr(0, status.find(':')), status.starts_with("failed") ? red : dim};
  if (!row.speedup_vs_serial) return {};
  const double ratio = *row.speedup_vs_serial;
  const std::string_view mark = mark_of_speedup(rows, row);
  return {three_digits(ratio) + (utf8 ? "×" : "x"),
          is_baseline(row.backend) ? dim
          : ratio < 1              ? red
                                   : green,
          mark.empty() || utf8 ? mark : ascii_ratio_mark};
}

RowCells cells_of(RowPointers rows, const ResultRow& row, const Provenance& provenance, bool utf8) {
  RowCells cells;
  cells[Shown::integrator].text = row.integrator;
  cells[Shown::backend].text = row.backend;
  cells[Shown::threads].text = std::to_string(row.threads);
  cells[Shown::verified] = verified_cell(row, utf8);
  cells[Shown::speedup] = speedup_cell(rows, row, utf8);
  if (row.ms_per_step)
    cells[Shown::ms] = {three_digits(*row.ms_per_step), {}, mark_of_excess(row, provenance)};
  if (row.ms_per_step_low && row.ms_per_step_high)
    cells[Shown::interval].text = three_digits(*row.ms_per_step_low)
                                      .append(utf8 ? "–" : "-")
                                      .append(three_digits(*row.ms_per_step_high));
  if (row.paper_ms) cells[Shown::published].text = decimal(*row.paper_ms);
  if (row.roofline_fraction) cells[Shown::roofline].text = three_digits(100 * *row.roofline_fraction) + " %";
  if (row.position_error) cells[Shown::error].text = fmt::format("{:.1e}", *row.position_error);
  return cells;
}

/// Adds the marks of a column to its texts, and as much space to texts without marks.
void add_marks(std::vector<RowCells>& lines, std::size_t column) {
  std::size_t widest = 0;
  for (const RowCells& line : lines) widest = std::max(widest, width_of(line[column].mark));
  for (RowCells& line : lines) {
    RowCell& cell = line[column];
    if (!cell.text.empty()) cell.text.append(cell.mark).append(widest - width_of(cell.mark), ' ');
  }
}

/// Widths of the columns, 0 for hidden ones, and the length of the longest bar.
struct RowLayout {
  std::array<std::size_t, Shown::count> width{};
  std::size_t bar = 0;

  /// Width of a line without its bar.
  std::size_t total() const {
    std::size_t sum = 0;
    for (const std::size_t one : width) sum += one > 0 ? gap.size() + one : 0;
    return sum;
  }
};

RowLayout layout_of(RowPointers rows, const std::vector<RowCells>& lines, std::optional<int> columns) {
  constexpr std::size_t shortest_bar = 8, longest_bar = 24;
  RowLayout layout;
  std::size_t ratio_width = 0;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (std::size_t column = 0; column < Shown::count; ++column)
      layout.width[column] = std::max(layout.width[column], width_of(lines[line][column].text));
    if (counts(*rows[line])) ratio_width = std::max(ratio_width, width_of(lines[line][Shown::speedup].text));
  }
  for (std::size_t column = 0; column < Shown::count; ++column)
    if (layout.width[column] > 0)
      layout.width[column] = std::max(layout.width[column], width_of(row_headers[column]));
  // Next to a bar, neither the header nor the word for a row without a bar needs a wider column.
  RowLayout with_bars = layout;
  with_bars.width[Shown::speedup] = ratio_width;
  const std::size_t fit = columns ? static_cast<std::size_t>(*columns) : SIZE_MAX;
  const auto has_room = [&] {
    return ratio_width > 0 ? with_bars.total() + gap.size() + shortest_bar <= fit : layout.total() <= fit;
  };
  for (const std::size_t column : {Shown::error, Shown::roofline, Shown::published, Shown::threads})
    if (!has_room()) layout.width[column] = with_bars.width[column] = 0;
  // Bars are dropped before intervals, and restored if these leave room.
  if (!has_room() && layout.total() > fit)
    layout.width[Shown::interval] = with_bars.width[Shown::interval] = 0;
  if (ratio_width == 0 || !has_room()) return layout;
  with_bars.bar = std::min(longest_bar, fit - with_bars.total() - gap.size());
  return with_bars;
}

std::string styled(const std::string& text, std::string_view style, bool colours) {
  if (!colours || style.empty() || text.empty()) return text;
  return std::string("\033[").append(style).append("m").append(text).append("\033[0m");
}

/// The columns of the layout next to each other; a line does not end with spaces.
std::string line_of(const RowCells& cells, const RowLayout& layout, bool colours) {
  std::string line, spaces;
  for (std::size_t column = 0; column < Shown::count; ++column) {
    if (layout.width[column] == 0) continue;
    const std::string& text = cells[column].text;
    const std::string padding(layout.width[column] - std::min(layout.width[column], width_of(text)), ' ');
    spaces += gap;
    if (is_flush_right(column)) spaces += padding;
    const std::size_t end = text.find_last_not_of(' ') + 1;
    if (end > 0)
      line += std::exchange(spaces, {}) + styled(text.substr(0, end), cells[column].style, colours);
    spaces.append(text.size() - end, ' ');
    if (!is_flush_right(column)) spaces += padding;
  }
  return line + '\n';
}

/// "cloth2500: 2,500 nodes, 14,502 springs (29,004 as Hong et al. count)", the last part if it fits.
std::string scene_line(const ResultRow& row, const Terminal& terminal) {
  const std::string name = escaped(row.scene);
  std::string sizes = fmt::format(": {} nodes, {} springs", grouped(row.nodes), grouped(row.springs_unique));
  if (row.springs_published) {
    const std::string published = fmt::format(" ({} as Hong et al. count)", grouped(*row.springs_published));
    if (width_of(name + sizes + published) <= static_cast<std::size_t>(terminal.width.value_or(INT_MAX)))
      sizes += published;
  }
  return styled(name, bold, terminal.colours) + sizes + '\n';
}

/// Why rows of a block have no time or a wrong one: each reason once, with its backends.
std::string reasons_of(RowPointers rows, std::size_t width) {
  std::vector<std::pair<std::string, std::vector<std::string>>> known;
  for (const ResultRow* row : rows) {
    if (counts(*row)) continue;
    const std::string reason = status_of(*row);
    auto at = std::ranges::find(known, reason, &decltype(known)::value_type::first);
    if (at == known.end()) at = known.insert(known.end(), {reason, {}});
    add_once(at->second, row->backend);
  }
  std::string text;
  for (const auto& [reason, backends] : known)
    text += "  " + wrapped(join(backends, ", ") + ": " + escaped(reason), width - 2, "    ") + '\n';
  return text;
}

}  // namespace

std::string row_table(RowPointers rows, const Provenance& provenance, const Terminal& terminal) {
  std::vector<RowCells> lines;
  double largest = 0;
  for (const ResultRow* row : rows) {
    lines.push_back(cells_of(rows, *row, provenance, terminal.utf8));
    if (counts(*row)) largest = std::max(largest, row->speedup_vs_serial.value_or(0));
  }
  add_marks(lines, Shown::ms);
  add_marks(lines, Shown::speedup);
  const RowLayout layout = layout_of(rows, lines, terminal.width);
  RowCells header;
  for (std::size_t column = 0; column < Shown::count; ++column)
    header[column] = {std::string(row_headers[column]), dim};
  std::string text;
  for (std::size_t first = 0, next = 0; first < rows.size(); first = next) {
    if (first > 0) text += '\n';
    text += scene_line(*rows[first], terminal) + line_of(header, layout, terminal.colours);
    for (; next < rows.size() && rows[next]->scene == rows[first]->scene; ++next) {
      RowCells& line = lines[next];
      // Repeated integrators are not shown.
      if (next > first && rows[next]->integrator == rows[next - 1]->integrator)
        line[Shown::integrator].text.clear();
      if (const std::optional<double> ratio = rows[next]->speedup_vs_serial; ratio && counts(*rows[next])) {
        std::string& last = line[Shown::speedup].text;
        last.insert(0, layout.width[Shown::speedup] - width_of(last), ' ');
        if (layout.bar > 0) last.append(gap).append(bar(*ratio / largest, layout.bar, terminal.utf8));
      }
      text += line_of(line, layout, terminal.colours);
    }
    text += reasons_of(rows.subspan(first, next - first),
                       terminal.width ? static_cast<std::size_t>(*terminal.width) : SIZE_MAX);
  }
  return text;
}

}  // namespace mssim
