#include <algorithm>
#include <cmath>

#include "cluster/step_model.h"
#include "output/tables/suite_tables.h"
#include "text/text.h"

namespace mssim {
namespace {

/// What stands before and behind the last `mark`; the whole and nothing where there is none.
std::pair<std::string_view, std::string_view> split_at_last(std::string_view text, std::string_view mark) {
  const std::size_t place = text.rfind(mark);
  if (place == std::string_view::npos) return {text, ""};
  return {text.substr(0, place), text.substr(place + mark.size())};
}

int ranks_of(std::string_view backend, const Provenance& provenance) {
  const auto program = std::ranges::find(provenance.backend_programs, backend, &BackendProgramRecord::name);
  return program == provenance.backend_programs.end() ? 0 : program->ranks;
}

/// Steps between two messages of a cloth in ranks, which say so in their note: "2 steps an exchange".
std::optional<int> steps_an_exchange(const ResultRow& row) {
  const std::size_t end = row.note.find(" an exchange");
  if (end == std::string::npos) return std::nullopt;
  const std::string_view steps = split_at_last(std::string_view(row.note).substr(0, end), ", ").second;
  return number_in<int>(steps.substr(0, steps.find(' ')));
}

/// Nodes a second.
double rate(const ResultRow& row) { return static_cast<double>(row.nodes) / *row.ms_per_step; }

/// A measured row of one scene in several processes.
struct ClusterRow {
  const ResultRow* row = nullptr;
  WideScene scene;
  std::string_view program;  ///< the backend without its number of ranks
  int ranks = 0;             ///< 0: one process that knows of no others
};

/// The rows of a run, and what follows from several of them.
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

  /// Nodes a second over those of one rank of the same program, times the ranks, on the same scene or on the
  /// one that it is a multiple of. None where either does not count.
  std::optional<double> efficiency(const ClusterRow& row) const { return efficiency(row, row.program, 1); }
  /// Nodes a second over those of as many copies that send nothing.
  std::optional<double> efficiency_of_copies(const ClusterRow& row) const {
    return efficiency(row, copies_backend, row.ranks);
  }
  /// Milliseconds of a step by the model of cluster/step_model.h, of a cloth in several ranks: from the time
  /// of copies, and from the speed of messages, their bytes and their number as the row has them.
  std::optional<double> modelled_ms(const ClusterRow& row) const {
    const ResultRow& measured = *row.row;
    const ResultRow* copies = counted_row(row, copies_backend, row.ranks);
    const std::optional<int> steps = steps_an_exchange(measured);
    if (!copies || row.program == copies_backend || row.ranks < 2 || !steps || !measured.latency_us ||
        !measured.link_gigabytes_per_second || measured.bytes_per_step.value_or(0) <= 0)
      return std::nullopt;
    const int stages = stages_of(measured);
    const ClothCut cut{1, row.ranks, *steps};
    ClothStep cloth{1, 0, stages};
    const double ghosts = ghost_nodes(cloth, cut);
    const double neighbours = std::min(row.ranks - 1, 2);
    const double message_bytes = *measured.bytes_per_step * *steps / neighbours;
    cloth.rows = std::round(message_bytes / (ghosts * message_node_bytes));
    cloth.columns = static_cast<double>(measured.nodes) / cloth.rows;
    const std::optional<ExchangeWork> work = work_of(cloth, cut);
    if (!work) return std::nullopt;
    const ClusterRates rates{
        .node_stage_s = *copies->ms_per_step / 1000 / static_cast<double>(copies->nodes) / stages,
        .latency_s = *measured.latency_us * 1e-6,
        .bytes_per_second = *measured.link_gigabytes_per_second * 1e9,
        .processor_copies = true};
    return 1000 * exchange_seconds(*work, rates) / *steps;
  }

  /// What all processes of a machine together take for a stage of a node.
  struct MachineRate {
    const ResultRow* row = nullptr;  ///< that says so
    double node_stage_s = 0;
  };
  /// That of the row with most copies of the largest cloth of which there is a model; none where there is
  /// no such row.
  std::optional<MachineRate> machine_rate() const {
    const ClusterRow* best = nullptr;
    for (const ClusterRow& row : rows_) {
      const bool is_modelled = std::ranges::any_of(rows_, [&](const ClusterRow& other) {
        return other.ranks == row.ranks && other.row->scene == row.row->scene && modelled_ms(other);
      });
      if (row.program != copies_backend || !counts(*row.row) || !is_modelled) continue;
      if (!best || std::pair(row.row->nodes, row.ranks) > std::pair(best->row->nodes, best->ranks))
        best = &row;
    }
    if (!best) return std::nullopt;
    return MachineRate{best->row, *best->row->ms_per_step / 1000 / static_cast<double>(best->row->nodes) /
                                      (best->ranks * stages_of(*best->row))};
  }

  int stages_of(const ResultRow& row) const { return stages_.at(row.integrator); }

 private:
  /// The row that has a time, of that program and so many ranks on the base of the scene; null: none.
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
    "Times are medians. *Computing*, *packing* and *waiting*: how the processes share the time of a step, on "
    "average; packing is all that the processor does for messages but wait for them. *Bytes* and *messages*: "
    "what the process with most sends in a step. *Efficiency*: nodes a second over those of one process, and "
    "over the number of processes. *Against copies*: nodes a second over those of as many processes that "
    "each step the whole scene for themselves (`mpi-copies`), which share the memory as well and send "
    "nothing. *Model*: what computing as fast as these copies, and the latency and bandwidth of messages as "
    "measured before the first step, add up to; in brackets over the measured time.";

std::optional<double> computing_share(const ResultRow& row) {
  if (!row.waiting_share || !row.packing_share) return std::nullopt;
  return std::max(0.0, 1 - *row.waiting_share - *row.packing_share);
}

/// Of which study a row is part.
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
  Cell interval, bytes, messages, model;
  if (ms) {
    interval = interval_text(*row.ms_per_step_low, *row.ms_per_step_high);
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
    if (!modelled || !counted_ms(*row.row)) continue;
    worst = std::max(worst, std::abs(*modelled / *row.row->ms_per_step - 1));
    ++count;
  }
  if (count == 0) return "";
  return fmt::format("The model is within {} % of the measured time in {} that it is made for",
                     two_digits(100 * worst), count == 1 ? "the row" : fmt::format("all {} rows", count));
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
    return first == last ? first : fmt::format("{} to {}", first, last);
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
    add_section(family, fmt::format("{}{} for all processes (strong scaling)", name, nodes),
                [](const ClusterRow& row) { return !is_weak(row); });
    const bool has_weak = std::ranges::any_of(
        rows.all(), [&](const ClusterRow& row) { return row.scene.base == family.first && is_weak(row); });
    if (has_weak) add_section(family, name + nodes + " a process (weak scaling)", is_beside_weak);
  }
  add_rows_without_a_time(page, pointers);
  return page;
}

/// A network as clusters have them: what is usual, not what any one of them does.
struct Network {
  std::string_view name;
  double latency_s = 0;
  double bytes_per_second = 0;
};
constexpr std::array<Network, 2> networks{
    {{"InfiniBand 100 Gbit/s", 1.5e-6, 11e9}, {"Ethernet 10 Gbit/s", 25e-6, 1.1e9}}};
constexpr std::array<double, 3> cloth_sides{1e4, 31'623, 1e5};  ///< of about 10^8, 10^9 and 10^10 nodes
constexpr std::array<int, 7> machine_counts{10, 30, 100, 300, 1000, 3000, 10'000};

/// Processors of a machine of a cluster; more where more were measured.
constexpr int usual_processors = 64;

struct Estimate {
  const Network* network = nullptr;
  double side = 0;
  int machines = 0;
  double perfect_s = 0;  ///< of a step without messages
  std::optional<CutTime> columns = {};
  std::optional<CutTime> blocks = {};
  std::optional<CutTime> shallow = {};  ///< the better one of both with an exchange every step
};

std::optional<CutTime> better(const std::optional<CutTime>& a, const std::optional<CutTime>& b) {
  if (!a || !b) return a ? a : b;
  return a->step_s <= b->step_s ? a : b;
}

std::vector<Estimate> estimates_of(const ClusterRows::MachineRate& machine, int stages) {
  std::vector<Estimate> all;
  for (const Network& network : networks)
    for (const double side : cloth_sides)
      for (const int machines : machine_counts) {
        const ClothStep cloth{side, side, stages};
        const ClusterRates rates{machine.node_stage_s, network.latency_s, network.bytes_per_second, false};
        all.push_back(
            {&network, side, machines, side * side * stages * machine.node_stage_s / machines,
             best_columns(cloth, machines, rates), best_blocks(cloth, machines, rates),
             better(best_columns(cloth, machines, rates, 1), best_blocks(cloth, machines, rates, 1))});
      }
  return all;
}

/// A text that is shown as 10^8.
std::string power_of_ten(double nodes) { return fmt::format("10^{}", std::lround(std::log10(nodes))); }

Cell efficiency_cell(const Estimate& estimate, const std::optional<CutTime>& cut) {
  return cut ? Cell(estimate.perfect_s / cut->step_s) : Cell();
}

Table data_of(const std::vector<Estimate>& estimates) {
  Table table;
  for (const Estimate& estimate : estimates) {
    const auto ms = [](const std::optional<CutTime>& cut) { return cut ? Cell(1000 * cut->step_s) : Cell(); };
    const auto part = [](const std::optional<CutTime>& cut, int ClothCut::*member) {
      return cut ? Cell(cut->cut.*member) : Cell();
    };
    table.add({{"network", estimate.network->name},
               {"latency_us", 1e6 * estimate.network->latency_s},
               {"gigabytes_per_second", 1e-9 * estimate.network->bytes_per_second},
               {"rows", std::lround(estimate.side)},
               {"columns", std::lround(estimate.side)},
               {"machines", estimate.machines},
               {"estimated_ms_one_step_an_exchange", ms(estimate.shallow)},
               {"estimated_ms_columns", ms(estimate.columns)},
               {"steps_an_exchange_columns", part(estimate.columns, &ClothCut::steps_an_exchange)},
               {"estimated_efficiency_columns", efficiency_cell(estimate, estimate.columns)},
               {"estimated_ms_blocks", ms(estimate.blocks)},
               {"blocks_down", part(estimate.blocks, &ClothCut::down)},
               {"blocks_across", part(estimate.blocks, &ClothCut::across)},
               {"steps_an_exchange_blocks", part(estimate.blocks, &ClothCut::steps_an_exchange)},
               {"estimated_efficiency_blocks", efficiency_cell(estimate, estimate.blocks)}});
  }
  return table;
}

/// A difference that pays.
constexpr double clearly_faster = 0.98;

bool halos_pay(const Estimate& estimate) {
  const std::optional<CutTime> best = better(estimate.columns, estimate.blocks);
  return best && best->step_s < clearly_faster * estimate.shallow->step_s;
}

bool blocks_pay(const Estimate& estimate) {
  return estimate.blocks &&
         (!estimate.columns || estimate.blocks->step_s < clearly_faster * estimate.columns->step_s);
}

/// "from 300 machines on", for the estimates of a network and a cloth.
template <class Pays>
std::string where(const std::vector<Estimate>& estimates, const Network& network, double side,
                  const Pays& pays) {
  for (const Estimate& estimate : estimates)
    if (estimate.network == &network && estimate.side == side && pays(estimate))
      return fmt::format("from {} machines on", grouped(static_cast<std::uint64_t>(estimate.machines)));
  return "nowhere up to " + grouped(machine_counts.back());
}

Cell percent(const Estimate& estimate, const std::optional<CutTime>& cut) {
  return cut ? Cell(three_digits(100 * estimate.perfect_s / cut->step_s)) : Cell("-");
}

Table table_of(const std::vector<Estimate>& estimates, const Network& network) {
  Table table{{{"nodes"},
               {"machines", Align::right},
               {"columns, ms, estimated", Align::right},
               {"steps an exchange", Align::right},
               {"efficiency", Align::right, " %"},
               {"blocks, ms, estimated", Align::right},
               {"cut", Align::right},
               {"steps an exchange", Align::right},
               {"efficiency", Align::right, " %"}},
              {}};
  for (const Estimate& estimate : estimates) {
    if (estimate.network != &network) continue;
    const auto ms = [](const std::optional<CutTime>& cut) {
      return cut ? Cell(three_digits(1000 * cut->step_s)) : Cell("-");
    };
    const auto steps = [](const std::optional<CutTime>& cut) {
      return cut ? Cell(cut->cut.steps_an_exchange) : Cell("-");
    };
    const std::string cut =
        estimate.blocks ? fmt::format("{} x {}", estimate.blocks->cut.down, estimate.blocks->cut.across)
                        : "-";
    table.rows.push_back({power_of_ten(estimate.side * estimate.side),
                          grouped(static_cast<std::uint64_t>(estimate.machines)), ms(estimate.columns),
                          steps(estimate.columns), percent(estimate, estimate.columns), ms(estimate.blocks),
                          cut, steps(estimate.blocks), percent(estimate, estimate.blocks)});
  }
  return table;
}

ResultTable cluster_estimates(const ClusterRows& rows, const ClusterRows::MachineRate& measured,
                              const Provenance& provenance) {
  const int stages = rows.stages_of(*measured.row);
  const int processors = std::max(usual_processors, measured.row->threads);
  ClusterRows::MachineRate machine = measured;
  machine.node_stage_s *= static_cast<double>(measured.row->threads) / processors;
  const std::vector<Estimate> estimates = estimates_of(machine, stages);
  Document page{
      Heading{1, "Estimated: many machines, larger cloths"},
      Paragraph{fmt::format(
          "Nothing on this page was measured but the speed of one machine: {}. Its {} together took {} ns a "
          "node and step of `{}` (`{}`, `{}`). A machine of this page has {} processors, each as fast, and "
          "sends to its neighbours as such a network usually does. The model is that of cluster.md, which "
          "holds it against measured times. *Columns*: each machine has some columns of the cloth, as `mpi` "
          "does. *Blocks*: some rows and columns. Both with as many steps between two exchanges, up to four "
          "stages, as take the least time. *Efficiency*: against a step without messages. A line - is where "
          "a part would be narrower than what its neighbours repeat of it.",
          made_by(provenance), pluralize(static_cast<std::uint64_t>(measured.row->threads), "processor"),
          three_digits(1e9 * measured.node_stage_s * stages), measured.row->integrator, measured.row->backend,
          measured.row->scene, processors)}};
  for (const Network& network : networks) {
    BulletList list;
    for (const double side : cloth_sides)
      list.items.push_back(power_of_ten(side * side) + " nodes: several steps an exchange pay " +
                           where(estimates, network, side, halos_pay) + ", blocks of rows and columns " +
                           where(estimates, network, side, blocks_pay));
    page.insert(page.end(),
                {Heading{2, std::string(network.name) + ": " + three_digits(1e6 * network.latency_s) +
                                " µs, " + three_digits(1e-9 * network.bytes_per_second) + " GB/s"},
                 table_of(estimates, network), std::move(list)});
  }
  return {"cluster-estimates", data_of(estimates), std::move(page)};
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
