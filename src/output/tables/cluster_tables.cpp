#include <algorithm>
#include <cmath>

#include "output/tables/suite_tables.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The text before and after the last `mark`; without a mark, the whole text and an empty one.
std::pair<std::string_view, std::string_view> split_at_last(std::string_view text, std::string_view mark) {
  const std::size_t place = text.rfind(mark);
  if (place == std::string_view::npos) return {text, ""};
  return {text.substr(0, place), text.substr(place + mark.size())};
}

int ranks_of(std::string_view backend, const Provenance& provenance) {
  const auto* program = found_in(provenance.backend_programs, backend, &BackendProgramRecord::name);
  return program ? program->ranks : 0;
}

/// Steps between two messages of a cloth in ranks, from the row's note: "2 steps an exchange".
std::optional<int> steps_an_exchange(const ResultRow& row) {
  const std::size_t end = row.note.find(" an exchange");
  if (end == std::string::npos) return std::nullopt;
  const std::string_view steps = split_at_last(std::string_view(row.note).substr(0, end), ", ").second;
  return number_in<int>(steps.substr(0, steps.find(' ')));
}

/// Nodes per millisecond.
double rate(const ResultRow& row) { return static_cast<double>(row.nodes) / *row.ms_per_step; }

/// A measured row of one scene in several processes.
struct ClusterRow {
  const ResultRow* row = nullptr;
  WideScene scene;
  std::string_view program;  ///< the backend without its number of ranks
  int ranks = 0;             ///< 0: one process without ranks
};

/// The rows of a run, and numbers derived from several of them.
class ClusterRows {
 public:
  /// `rows` and `provenance` must outlive this.
  ClusterRows(RowPointers rows, const Provenance& provenance, StageCounts stages)
      : stages_(std::move(stages)) {
    for (const ResultRow* row : rows)
      rows_.push_back({row, wide_scene(row->scene), split_at_last(row->backend, ":").first,
                       ranks_of(row->backend, provenance)});
  }

  const std::vector<ClusterRow>& all() const { return rows_; }

  /// Nodes per second relative to one rank of the same program times the number of ranks, on the same scene
  /// or on the base of a wide scene. None if either row does not count.
  std::optional<double> efficiency(const ClusterRow& row) const { return efficiency(row, row.program, 1); }
  /// Nodes per second relative to as many copies without messages.
  std::optional<double> efficiency_of_copies(const ClusterRow& row) const {
    return efficiency(row, copies_backend, row.ranks);
  }
  /// Modelled ms per step of a cloth in several ranks: computing takes as long as in copies, and messages
  /// take the row's latency and bandwidth. The processor transfers them and computes nothing meanwhile. Each
  /// rank has some of the columns. None if a number is missing, or if a rank has fewer columns than its
  /// neighbours repeat.
  std::optional<double> modelled_ms(const ClusterRow& row) const {
    const ResultRow& measured = *row.row;
    const ResultRow* copies = counted_row(row, copies_backend, row.ranks);
    const std::optional<int> steps = steps_an_exchange(measured);
    if (!copies || row.program == copies_backend || row.ranks < 2 || !steps || !measured.latency_us ||
        !measured.link_gigabytes_per_second || measured.bytes_per_step.value_or(0) <= 0)
      return std::nullopt;
    constexpr double reach = 2;        // nodes that a spring reaches (BandLayout::halo)
    constexpr double node_bytes = 24;  // of a node in a message: position and velocity
    const double stages = stages_.at(measured.integrator) * *steps;
    const double ghosts = reach * stages;  // columns on each side that repeat a neighbour's
    const double neighbours = std::min(row.ranks - 1, 2);
    const double bytes = *measured.bytes_per_step * *steps;
    const double rows = std::round(bytes / (neighbours * ghosts * node_bytes));
    const double columns = static_cast<double>(measured.nodes) / rows / row.ranks;
    if (columns < ghosts) return std::nullopt;
    // The first stage needs all ghosts except those within a spring's reach, the last one none: half on
    // average.
    const double computed = std::ceil(columns) + neighbours * (ghosts - reach) / 2;
    const double stages_of_copies = static_cast<double>(copies->nodes) * stages_.at(measured.integrator);
    const double computing_ms = stages * rows * computed * *copies->ms_per_step / stages_of_copies;
    const double messages_ms =
        *measured.latency_us / 1000 + bytes / (*measured.link_gigabytes_per_second * 1e6);
    return (computing_ms + messages_ms) / *steps;
  }

 private:
  /// The row with a time for that program and number of ranks, on the base of the scene; null if there is
  /// none.
  const ResultRow* counted_row(const ClusterRow& like, std::string_view program, int ranks) const {
    const auto found = std::ranges::find_if(rows_, [&](const ClusterRow& other) {
      return other.row->scene == like.scene.base && other.row->integrator == like.row->integrator &&
             other.program == program && other.ranks == ranks;
    });
    return found != rows_.end() && counted_ms(*found->row) ? found->row : nullptr;
  }

  std::optional<double> efficiency(const ClusterRow& row, std::string_view program, int ranks) const {
    const ResultRow* other = counted_row(row, program, ranks);
    if (!other || row.ranks == 0 || row.program == copies_backend || !counted_ms(*row.row))
      return std::nullopt;
    return rate(*row.row) / (row.ranks * rate(*other));
  }

  std::vector<ClusterRow> rows_;
  StageCounts stages_;
};

constexpr std::string_view how_to_read_clusters =
    "Times are medians. *Computing*, *packing* and *waiting*: shares of the time per step, averaged over the "
    "processes; packing is all work on messages except waiting. *Bytes* and *messages*: sent per step by the "
    "process that sends most. *Efficiency*: nodes per second, divided by those of one process and by the "
    "number of processes. *Against copies*: nodes per second, divided by those of the same number of "
    "processes that each step the whole scene (`mpi-copies`); these share the memory too, but send nothing. "
    "*Model*: the time of computing as fast as these copies plus that of messages, from the latency and "
    "bandwidth measured before the first step; in brackets, divided by the measured time.";

std::optional<double> computing_share(const ResultRow& row) {
  if (!row.waiting_share || !row.packing_share) return std::nullopt;
  return std::max(0.0, 1 - *row.waiting_share - *row.packing_share);
}

/// The study that a row belongs to.
std::string_view scaling_of(const ClusterRow& row) {
  if (row.ranks == 0) return "one process";
  if (row.program == copies_backend) return "copies";
  return row.scene.times == 1 ? "strong" : "weak";
}

Table data_of(const ClusterRows& rows) {
  Table table;
  for (const ClusterRow& cluster_row : rows.all()) {
    const ResultRow& row = *cluster_row.row;
    const std::optional<double> model = rows.modelled_ms(cluster_row);
    table.add({{"scaling", scaling_of(cluster_row)},
               {"scene", row.scene},
               {"nodes", row.nodes},
               {"integrator", row.integrator},
               {"backend", row.backend},
               {"ranks", cluster_row.ranks},
               {"threads", row.threads},
               {"ms_per_step", row.ms_per_step},
               {"ms_per_step_low", row.ms_per_step_low},
               {"ms_per_step_high", row.ms_per_step_high},
               {"computing_share", computing_share(row)},
               {"packing_share", row.packing_share},
               {"waiting_share", row.waiting_share},
               {"bytes_per_step", row.bytes_per_step},
               {"messages_per_step", row.messages_per_step},
               {"latency_us", row.latency_us},
               {"link_gigabytes_per_second", row.link_gigabytes_per_second},
               {"efficiency", rows.efficiency(cluster_row)},
               {"efficiency_against_copies", rows.efficiency_of_copies(cluster_row)},
               {"modelled_ms_per_step", model},
               {"verified", row.verified},
               {"status", status_of(row)},
               {"note", row.note}});
  }
  return table;
}

const std::vector<Column> columns_of_cluster{{"backend"},
                                             {"ms per step", Align::right},
                                             {"interval", Align::right},
                                             {"computing", Align::right, " %"},
                                             {"packing", Align::right, " %"},
                                             {"waiting", Align::right, " %"},
                                             {"bytes", Align::right},
                                             {"messages", Align::right},
                                             {"efficiency", Align::right},
                                             {"against copies", Align::right},
                                             {"model, ms", Align::right}};

std::vector<Cell> cells_of(const ClusterRows& rows, const ClusterRow& cluster_row) {
  const ResultRow& row = *cluster_row.row;
  const std::optional<double> ms = counted_ms(row);
  const auto percent = [&](const std::optional<double>& share) {
    return ms && share ? Cell(fmt::format("{:.1f}", 100 * *share)) : Cell();
  };
  const auto ratio = [](const std::optional<double>& value) {
    return value ? Cell(fmt::format("{:.2f}", *value)) : Cell();
  };
  std::string label = "`" + row.backend + "`";
  if (cluster_row.scene.times > 1) label += fmt::format(" on `{}`", row.scene);
  Cell bytes, messages, model;
  if (ms) {
    if (row.bytes_per_step && cluster_row.ranks > 1)
      bytes = grouped(static_cast<std::uint64_t>(std::llround(*row.bytes_per_step)));
    if (row.messages_per_step && cluster_row.ranks > 1) messages = three_digits(*row.messages_per_step);
  }
  if (const auto modelled = rows.modelled_ms(cluster_row); modelled && ms) {
    model = *modelled;
    model.suffix = in_brackets(*modelled / *ms);
  }
  return {label,
          measured_cell(&row, ms),
          interval_cell(row),
          percent(computing_share(row)),
          percent(row.packing_share),
          percent(row.waiting_share),
          bytes,
          messages,
          ratio(rows.efficiency(cluster_row)),
          ratio(rows.efficiency_of_copies(cluster_row)),
          model};
}

/// Largest deviation of the model from the measurements, and the number of rows; empty without modelled rows.
std::string verdict_on_model(const ClusterRows& rows) {
  double worst = 0;
  std::uint64_t count = 0;
  for (const ClusterRow& row : rows.all()) {
    const auto modelled = rows.modelled_ms(row);
    if (!modelled || !counted_ms(*row.row)) continue;
    worst = std::max(worst, std::abs(*modelled / *row.row->ms_per_step - 1));
    ++count;
  }
  if (count == 0) return "";
  return fmt::format("The model is within {} % of the measured time in {} that it covers",
                     two_digits(100 * worst), count == 1 ? "the row" : fmt::format("all {} rows", count));
}

/// Latency and bandwidth of the rows.
std::string links_of(const ClusterRows& rows) {
  std::vector<double> latencies, bandwidths;
  for (const ClusterRow& row : rows.all()) {
    if (!row.row->latency_us || !row.row->link_gigabytes_per_second || !counts(*row.row)) continue;
    latencies.push_back(*row.row->latency_us);
    bandwidths.push_back(*row.row->link_gigabytes_per_second);
  }
  if (latencies.empty()) return "";
  const auto range = [](const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    const std::string first = three_digits(low), last = three_digits(high);
    return first == last ? first : fmt::format("{} to {}", first, last);
  };
  return "A message of 8 bytes to a neighbour took " + range(latencies) + " µs; one of 64 KiB reached " +
         range(bandwidths) + " GB/s while another one arrived";
}

bool is_weak(const ClusterRow& row) { return row.scene.times > 1; }

/// Whether it belongs to weak scaling: one process of the base scene, or copies of it.
bool is_beside_weak(const ClusterRow& row) {
  return is_weak(row) || row.program == copies_backend || row.ranks == 1;
}

Document page_of(const ClusterRows& rows, RowPointers pointers, const Provenance& provenance) {
  Document page{Heading{1, "Cluster: a scene in several processes"}, measured_on(pointers, provenance),
                Paragraph{std::string(how_to_read_clusters)}};
  add_sentence(page, verdict_on_model(rows));
  add_sentence(page, links_of(rows));
  std::vector<std::pair<std::string_view, std::string_view>> families;  // base scene, integrator
  for (const ClusterRow& row : rows.all()) add_once(families, {row.scene.base, row.row->integrator});
  const auto add_section = [&](const auto& family, const std::string& title, const auto& belongs) {
    Table table{columns_of_cluster, {}};
    for (const ClusterRow& row : rows.all())
      if (row.scene.base == family.first && row.row->integrator == family.second && belongs(row))
        table.rows.push_back(cells_of(rows, row));
    if (!table.rows.empty()) page.insert(page.end(), {Heading{2, title}, std::move(table)});
  };
  for (const auto& family : families) {
    const auto base = std::ranges::find_if(
        rows.all(), [&](const ClusterRow& row) { return row.scene.base == family.first && !is_weak(row); });
    const std::string nodes = base == rows.all().end() ? "" : grouped(base->row->nodes) + " nodes";
    const std::string name = std::string(family.first) + ", " + std::string(family.second) + ": ";
    add_section(family, fmt::format("{}{} for all processes (strong scaling)", name, nodes),
                [](const ClusterRow& row) { return !is_weak(row); });
    const bool has_weak = std::ranges::any_of(
        rows.all(), [&](const ClusterRow& row) { return row.scene.base == family.first && is_weak(row); });
    if (has_weak) add_section(family, name + nodes + " per process (weak scaling)", is_beside_weak);
  }
  add_rows_without_a_time(page, pointers);
  return page;
}

}  // namespace

std::string name_in_ranks(std::string_view backend, int ranks) {
  return fmt::format("{}:{}", backend, ranks);
}

WideScene wide_scene(std::string_view scene) {
  const auto [base, times] = split_at_last(scene, "-x");
  const auto number = number_in<int>(times);
  return number && *number > 1 ? WideScene{base, *number} : WideScene{scene, 1};
}

TableMaker cluster_tables(StageCounts stages) {
  return [stages = std::move(stages)](std::span<const ResultRow> rows, const Provenance& provenance) {
    if (rows.empty()) return std::vector<ResultTable>();
    const std::vector<const ResultRow*> pointers = pointers_to(rows);
    const ClusterRows cluster(pointers, provenance, stages);
    return std::vector<ResultTable>{{"cluster", data_of(cluster), page_of(cluster, pointers, provenance)}};
  };
}

}  // namespace mssim
