#include "output/tables/results.h"

#include <fmt/format.h>

#include <set>

#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Start of a row's device if its backend chose an instruction set, whose name follows, one word; or if a
/// program of the user's says more of the CPU.
constexpr std::string_view host_with_vectors = "cpu ";

/// Instruction set that the row's backend chose on the host ("AVX-512"); otherwise empty.
std::string_view instruction_set(const ResultRow& row) {
  const std::string_view device = row.device;
  if (!device.starts_with(host_with_vectors)) return {};
  const std::string_view rest = device.substr(host_with_vectors.size());
  return rest.find(' ') == std::string_view::npos ? instruction_set_name(rest) : std::string_view();
}

constexpr std::string_view ratio_mark = "†";

/// The number as shown with three digits.
double rounded(double value) { return number_in<double>(three_digits(value)).value_or(value); }

/// The meaning of `mark`.
std::string legend(std::string_view mark) {
  return std::string(mark) +
         " the two times shown contradict this ratio: their quotient differs from it by more than a quarter, "
         "or names the other one as the faster; trust the ratio, which compares single samples instead of "
         "medians";
}

}  // namespace

std::vector<const ResultRow*> pointers_to(std::span<const ResultRow> rows) {
  return mapped<const ResultRow*>(rows, [](const ResultRow& row) { return &row; });
}

const ResultRow* find_row(RowPointers rows, std::string_view scene, std::string_view backend,
                          std::string_view integrator) {
  const auto row = std::ranges::find_if(rows, [&](const ResultRow* candidate) {
    return candidate->scene == scene && candidate->backend == backend && candidate->integrator == integrator;
  });
  return row == rows.end() ? nullptr : *row;
}

const ResultRow* baseline_of(RowPointers rows, const ResultRow& row) {
  const ResultRow* serial = find_row(rows, row.scene, baseline_name, row.integrator);
  return serial != nullptr ? serial : find_row(rows, row.scene, browser_baseline_name, row.integrator);
}

std::string made_by(const Provenance& provenance) {
  const BuildInfo& build = provenance.build;
  return fmt::format("mssim {}, commit {}{}; {}", build.version, build.commit.substr(0, 12),
                     build.dirty ? " with uncommitted changes" : "", provenance.started_utc);
}

Paragraph measured_on(RowPointers rows, const Provenance& provenance) {
  std::set<std::string_view> instruction_sets, devices;
  for (const ResultRow* row : rows) {
    instruction_sets.insert(instruction_set(*row));
    devices.insert(opencl_device(*row));
  }
  const auto number = [](int of, std::string_view noun) { return pluralize(of, noun); };
  std::string text = fmt::format("Measured on {} ({}) with {}", cpu_name(provenance.machine),
                                 number(provenance.machine.logical_cpus, "logical CPU"),
                                 number(provenance.threads, "thread"));
  for (const std::string_view set : instruction_sets)
    if (!set.empty()) text.append("; ").append(set).append(" vectors");
  for (const std::string_view device : devices)
    if (!device.empty()) text.append("; device ").append(device_name(device));
  return {text + "; " + made_by(provenance) + "."};
}

std::string_view opencl_device(const ResultRow& row) {
  const bool host = row.device == "cpu" || row.device.starts_with(host_with_vectors);
  return host ? std::string_view() : std::string_view(row.device);
}

bool is_this_processor(std::string_view device, const Provenance& provenance) {
  if (device.empty()) return false;
  // CPU drivers name their device after the processor's model; some models have no name.
  const std::string& processor = provenance.machine.cpu_model;
  if (!processor.empty() && device.find(processor) != std::string_view::npos) return true;
  return std::ranges::any_of(provenance.opencl_devices, [&](const std::string& known) {
    return known.find(device) != std::string::npos &&
           (known.starts_with("Portable Computing Language") || known.starts_with("Oclgrind"));
  });
}

const ResultRow* row_with_device(RowPointers rows, std::string_view backend) {
  const auto row = std::ranges::find_if(rows, [&](const ResultRow* candidate) {
    return candidate->backend == backend && !opencl_device(*candidate).empty();
  });
  return row == rows.end() ? nullptr : *row;
}

std::string backend_label(RowPointers rows, std::string_view backend, const Provenance& provenance) {
  const ResultRow* row = row_with_device(rows, backend);
  if (!row) return fmt::format("`{}`", backend);
  const std::string device = device_name(opencl_device(*row));
  return is_this_processor(opencl_device(*row), provenance)
             ? fmt::format("`{}` on the CPU ({})", backend, device)
             : fmt::format("`{}` on {}", backend, device);
}

std::optional<double> counted_ms(const ResultRow& row) {
  return counts(row) ? row.ms_per_step : std::nullopt;
}

Cell measured_cell(const ResultRow* row, const std::optional<double>& value) {
  if (row == nullptr) return {};
  const std::string status = status_of(*row);
  Cell cell = value ? Cell(*value) : Cell(status.substr(0, status.find(':')));
  cell.strong = value.has_value();
  return cell;
}

std::string interval_text(double low, double high) { return three_digits(low) + " to " + three_digits(high); }

Cell interval_cell(const ResultRow& row) {
  if (!counted_ms(row) || !has_interval(row)) return {};
  return interval_text(*row.ms_per_step_low, *row.ms_per_step_high);
}

std::optional<double> ns_per_node(const ResultRow& row, const std::optional<double>& ms) {
  if (!counts(row) || !ms) return std::nullopt;
  return *ms * 1e6 / static_cast<double>(row.nodes);
}

Column scene_column(const ResultRow& row) { return {row.scene + '\n' + grouped(row.nodes), Align::right}; }

std::string in_brackets(double ratio) { return " (" + three_digits(ratio) + "×)"; }

std::string_view mark_of_speedup(RowPointers rows, const ResultRow& row) {
  const ResultRow* serial = baseline_of(rows, row);
  if (serial == nullptr || !serial->ms_per_step || !row.ms_per_step || !row.speedup_vs_serial) return "";
  return mark_of_ratio(*row.speedup_vs_serial, *serial->ms_per_step, *row.ms_per_step);
}

std::string_view mark_of_excess(const ResultRow& row, const Provenance& provenance) {
  return exceeds(row, asked_processors(provenance, row.backend).count) ? " (!)" : "";
}

std::string legend_of_excess(RowPointers rows, const Provenance& provenance) {
  std::set<std::string> backends;
  for (const ResultRow* row : rows)
    if (const int asked = asked_processors(provenance, row->backend).count; exceeds(*row, asked))
      backends.insert(fmt::format("{} ({} instead of {})", row->backend, row->threads, asked));
  if (backends.empty()) return {};
  return fmt::format("(!) on more processors than requested: {}", fmt::join(backends, ", "));
}

std::optional<RatioInterval> times_as_fast(const ResultRow* row, const ResultRow* than) {
  if (!row || !than || !counts(*row) || !counts(*than)) return std::nullopt;
  if (!row->samples_ms.empty() && row->samples_ms.size() == than->samples_ms.size()) {
    const MedianInterval ratio = median_ratio(than->samples_ms, row->samples_ms);
    return RatioInterval{ratio.median, ratio.low, ratio.high, ratio.coverage >= interval_confidence};
  }
  if (!row->ms_per_step || !than->ms_per_step) return std::nullopt;
  const auto end = [](const ResultRow& of, std::optional<double> ResultRow::*value) {
    return (of.*value).value_or(*of.ms_per_step);
  };
  return RatioInterval{*than->ms_per_step / *row->ms_per_step,
                       end(*than, &ResultRow::ms_per_step_low) / end(*row, &ResultRow::ms_per_step_high),
                       end(*than, &ResultRow::ms_per_step_high) / end(*row, &ResultRow::ms_per_step_low),
                       has_interval(*row) && has_interval(*than)};
}

Cell ratio_cell(const std::optional<RatioInterval>& ratio, const ResultRow* time, const ResultRow* other) {
  if (!ratio) return {};
  Cell cell = ratio->ratio;
  cell.suffix = mark_of_ratio(ratio->ratio, *time->ms_per_step, *other->ms_per_step);
  return cell;
}

Cell ratio_interval_cell(const std::optional<RatioInterval>& ratio) {
  return ratio && ratio->covers ? Cell(interval_text(ratio->low, ratio->high)) : Cell();
}

std::string reason_without_speedups(std::span<const std::string_view> backends) {
  if (backends.empty() || std::ranges::any_of(backends, is_baseline)) return {};
  return "speed-ups are missing, since serial is not among the backends; add it to --backend";
}

std::string reason_without_speedups(RowPointers rows) {
  return reason_without_speedups(mapped<std::string_view>(rows, &ResultRow::backend));
}

void add_rows_without_a_time(Document& page, RowPointers rows) {
  std::vector<std::pair<std::string, std::string>> remarks;  // reason, scenes
  for (const ResultRow* row : rows) {
    if (counts(*row)) continue;
    const std::string reason = fmt::format("`{}`, `{}`: {}", row->backend, row->integrator, status_of(*row));
    auto known = std::ranges::find(remarks, reason, &std::pair<std::string, std::string>::first);
    if (known == remarks.end()) known = remarks.insert(remarks.end(), {reason, ""});
    known->second += (known->second.empty() ? "`" : ", `") + row->scene + "`";
  }
  if (remarks.empty()) return;
  BulletList list;
  for (const auto& [reason, scenes] : remarks) list.items.push_back(reason + " (" + scenes + ")");
  page.insert(page.end(), {Heading{2, "Rows without a time"}, std::move(list)});
}

std::string_view mark_of_ratio(double ratio, double time, double other) {
  constexpr double largest_difference = 1.25;
  const double shown = rounded(ratio), quotient = rounded(time) / rounded(other);
  const bool differs = std::max(shown / quotient, quotient / shown) > largest_difference;
  return differs || (shown - 1) * (quotient - 1) < 0 ? ratio_mark : "";
}

std::string legend_of_ratios(std::string_view table) {
  for (const std::string_view mark : {ratio_mark, ascii_ratio_mark})
    if (table.find(mark) != std::string_view::npos) return legend(mark);
  return "";
}

std::string legend_of_ratios(const Document& page) {
  for (const auto& block : page)
    if (const auto* table = std::get_if<Table>(&block))
      for (const std::vector<Cell>& row : table->rows)
        for (const Cell& cell : row)
          if (cell.suffix.find(ratio_mark) != std::string::npos) return legend(ratio_mark);
  return "";
}

}  // namespace mssim
