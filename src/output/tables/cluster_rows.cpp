#include "output/tables/cluster_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace

std::string name_in_ranks(std::string_view backend, int ranks) {
  return std::string(backend) + ':' + std::to_string(ranks);
}

WideScene wide_scene(std::string_view scene) {
  const auto [base, times] = split_at_last(scene, "-x");
  const auto number = number_in<int>(times);
  return number && *number > 1 ? WideScene{base, *number} : WideScene{scene, 1};
}

ClusterRows::ClusterRows(RowPointers rows, const Provenance& provenance, StageCounts stages)
    : stages_(std::move(stages)) {
  for (const ResultRow* row : rows)
    rows_.push_back({row, wide_scene(row->scene), split_at_last(row->backend, ":").first,
                     ranks_of(row->backend, provenance)});
}

const ResultRow* ClusterRows::pluralize(const ClusterRow& like, std::string_view program, int ranks) const {
  const auto found = std::ranges::find_if(rows_, [&](const ClusterRow& other) {
    return other.row->scene == like.scene.base && other.row->integrator == like.row->integrator &&
           other.program == program && other.ranks == ranks;
  });
  return found != rows_.end() && counts(*found->row) && found->row->ms_per_step ? found->row : nullptr;
}

std::optional<double> ClusterRows::efficiency(const ClusterRow& row) const {
  const ResultRow* one = pluralize(row, row.program, 1);
  if (!one || row.ranks == 0 || row.program == copies_backend || !counts(*row.row) || !row.row->ms_per_step)
    return std::nullopt;
  return rate(*row.row) / (row.ranks * rate(*one));
}

std::optional<double> ClusterRows::efficiency_of_copies(const ClusterRow& row) const {
  const ResultRow* copies = pluralize(row, copies_backend, row.ranks);
  if (!copies || row.program == copies_backend || !counts(*row.row) || !row.row->ms_per_step)
    return std::nullopt;
  return rate(*row.row) / (row.ranks * rate(*copies));
}

std::optional<double> ClusterRows::modelled_ms(const ClusterRow& row) const {
  const ResultRow& measured = *row.row;
  const ResultRow* copies = pluralize(row, copies_backend, row.ranks);
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

std::optional<ClusterRows::MachineRate> ClusterRows::machine_rate() const {
  const ClusterRow* best = nullptr;
  for (const ClusterRow& row : rows_) {
    const bool is_modelled = std::ranges::any_of(rows_, [&](const ClusterRow& other) {
      return other.ranks == row.ranks && other.row->scene == row.row->scene && modelled_ms(other);
    });
    if (row.program != copies_backend || !counts(*row.row) || !is_modelled) continue;
    if (!best || std::pair(row.row->nodes, row.ranks) > std::pair(best->row->nodes, best->ranks)) best = &row;
  }
  if (!best) return std::nullopt;
  return MachineRate{best->row, *best->row->ms_per_step / 1000 / static_cast<double>(best->row->nodes) /
                                    (best->ranks * stages_of(*best->row))};
}

}  // namespace mssim
