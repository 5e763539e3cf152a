#include "output/tables/cluster_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/tables/cluster_estimates.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view how_to_read_clusters =
    "Times are medians. *Computing*, *packing* and *waiting*: how the processes share the time of a step, on "
    "average; packing is all that the processor does for messages but wait for them. *Bytes* and *messages*: "
    "what the process with most sends in a step. *Efficiency*: nodes a "
    "second over those of one process, and over the number of processes. *Against copies*: nodes a second "
    "over those of as many processes that each step the whole scene for themselves (`mpi-copies`), which "
    "share the memory as well and send nothing. *Model*: what computing as fast as these copies, and the "
    "latency and bandwidth of messages as measured before the first step, add up to; in brackets over the "
    "measured time.";

std::optional<double> computing_share(const ResultRow& row) {
  if (!row.waiting_share || !row.packing_share) return std::nullopt;
  return std::max(0.0, 1 - *row.waiting_share - *row.packing_share);
}

/// What a row is part of.
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
  const std::optional<double> ms = counts(row) ? row.ms_per_step : std::nullopt;
  const auto percent = [&](const std::optional<double>& share) {
    return ms && share ? Cell(fixed_decimal(100 * *share, 1)) : Cell();
  };
  const auto ratio = [](const std::optional<double>& value) {
    return value ? Cell(fixed_decimal(*value, 2)) : Cell();
  };
  std::string label = "`" + row.backend + "`";
  if (cluster_row.scene.times > 1) label += " on `" + row.scene + "`";
  Cell interval, bytes, messages, model;
  if (ms) {
    interval = three_digits(*row.ms_per_step_low) + " to " + three_digits(*row.ms_per_step_high);
    if (row.bytes_per_step && cluster_row.ranks > 1) {
      bytes = grouped(static_cast<std::uint64_t>(std::llround(*row.bytes_per_step)));
      messages = three_digits(*row.messages_per_step);
    }
  }
  if (const auto modelled = rows.modelled_ms(cluster_row); modelled && ms) {
    model = *modelled;
    model.suffix = in_brackets(*modelled / *ms);
  }
  return {label,
          measured_cell(&row, ms),
          interval,
          percent(computing_share(row)),
          percent(row.packing_share),
          percent(row.waiting_share),
          bytes,
          messages,
          ratio(rows.efficiency(cluster_row)),
          ratio(rows.efficiency_of_copies(cluster_row)),
          model};
}

/// How far the model is from what was measured at most, in how many rows; nothing where it says nothing.
std::string verdict_on_model(const ClusterRows& rows) {
  double worst = 0;
  std::uint64_t count = 0;
  for (const ClusterRow& row : rows.all()) {
    const auto modelled = rows.modelled_ms(row);
    if (!modelled || !counts(*row.row) || !row.row->ms_per_step) continue;
    worst = std::max(worst, std::abs(*modelled / *row.row->ms_per_step - 1));
    ++count;
  }
  if (count == 0) return "";
  return "The model is within " + two_digits(100 * worst) + " % of the measured time in " +
         (count == 1 ? "the row" : "all " + std::to_string(count) + " rows") + " that it is made for";
}

/// The latency and bandwidth that rows were measured with.
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
    return first == last ? first : first + " to " + last;
  };
  return "A message of 8 bytes to a neighbour took " + range(latencies) + " µs, one of 64 KiB went with " +
         range(bandwidths) + " GB/s while another one came";
}

bool is_weak(const ClusterRow& row) { return row.scene.times > 1; }

/// Does it belong beside weak scaling: one process of the base, or copies of it?
bool is_beside_weak(const ClusterRow& row) {
  return is_weak(row) || row.program == copies_backend || row.ranks == 1;
}

Document page_of(const ClusterRows& rows, RowPointers pointers, const Provenance& provenance) {
  Document page{Heading{1, "Cluster: a scene in several processes"}, measured_on(pointers, provenance),
                Paragraph{std::string(how_to_read_clusters)}};
  add_sentence(page, verdict_on_model(rows));
  add_sentence(page, links_of(rows));
  std::vector<std::pair<std::string_view, std::string_view>> families;  // base scene, integrator
  for (const ClusterRow& row : rows.all())
    if (const auto family =
            std::pair<std::string_view, std::string_view>(row.scene.base, row.row->integrator);
        std::ranges::find(families, family) == families.end())
      families.push_back(family);
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
    add_section(family, name + nodes + " for all processes (strong scaling)",
                [](const ClusterRow& row) { return !is_weak(row); });
    const bool has_weak = std::ranges::any_of(
        rows.all(), [&](const ClusterRow& row) { return row.scene.base == family.first && is_weak(row); });
    if (has_weak) add_section(family, name + nodes + " a process (weak scaling)", is_beside_weak);
  }
  add_rows_without_a_time(page, pointers);
  return page;
}

}  // namespace

TableMaker cluster_tables(StageCounts stages) {
  return [stages = std::move(stages)](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    if (rows.empty()) return tables;
    const std::vector<const ResultRow*> pointers = pointers_to(rows);
    const ClusterRows cluster(pointers, provenance, stages);
    tables.push_back({"cluster", data_of(cluster), page_of(cluster, pointers, provenance)});
    if (const auto machine = cluster.machine_rate())
      tables.push_back(cluster_estimates(cluster, *machine, provenance));
    return tables;
  };
}

}  // namespace mssim
