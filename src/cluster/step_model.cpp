#include "cluster/step_model.h"

#include <algorithm>
#include <cmath>

namespace mssim {
namespace {

/// Nodes that a spring reaches (BandLayout::halo).
constexpr double reach = 2;

/// Neighbours of a part in the middle of so many.
double neighbours(int parts) { return std::min(parts - 1, 2); }

/// The better one of what is known and a cut; `known` may be none.
void take_better(std::optional<CutTime>& known, const ClothStep& step, const ClothCut& cut,
                 const ClusterRates& rates) {
  const std::optional<ExchangeWork> work = work_of(step, cut);
  if (!work) return;
  const double step_s = exchange_seconds(*work, rates) / cut.steps_an_exchange;
  if (!known || step_s < known->step_s) known = CutTime{cut, step_s};
}

}  // namespace

double exchange_seconds(const ExchangeWork& work, const ClusterRates& rates) {
  const double computing = work.node_stages * rates.node_stage_s;
  const double inner = work.inner_node_stages * rates.node_stage_s;
  const double latency = work.rounds_of_messages * rates.latency_s;
  const double volume = work.bytes > 0 ? work.bytes / rates.bytes_per_second : 0;
  const double hidden = rates.processor_copies ? 0 : inner;
  return computing + std::max(0.0, latency + volume - hidden);
}

double ghost_nodes(const ClothStep& step, const ClothCut& cut) {
  return reach * step.stages * cut.steps_an_exchange;
}

std::optional<ExchangeWork> work_of(const ClothStep& step, const ClothCut& cut) {
  const double rows = std::ceil(step.rows / cut.down), columns = std::ceil(step.columns / cut.across);
  const double ghosts = ghost_nodes(step, cut);
  if ((cut.down > 1 && step.rows / cut.down < ghosts) ||
      (cut.across > 1 && step.columns / cut.across < ghosts))
    return std::nullopt;
  const double above = neighbours(cut.down), beside = neighbours(cut.across);
  // The first stage needs all ghosts but those that a spring reaches, the last one none: half of that on
  // average.
  const double twice = (ghosts - reach) / 2;
  const double stages = step.stages * cut.steps_an_exchange;
  ExchangeWork work;
  work.node_stages = stages * (rows + above * twice) * (columns + beside * twice);
  work.inner_node_stages =
      stages * std::max(0.0, rows - above * ghosts) * std::max(0.0, columns - beside * ghosts);
  // Rows are sent with the ghosts that have come from beside, so that corners need no messages of their own.
  work.bytes = message_node_bytes * ghosts * (beside * rows + above * (columns + beside * ghosts));
  work.rounds_of_messages = (cut.across > 1 ? 1 : 0) + (cut.down > 1 ? 1 : 0);
  return work;
}

std::optional<CutTime> best_columns(const ClothStep& step, int processes, const ClusterRates& rates,
                                    int most_stages) {
  std::optional<CutTime> best;
  for (int steps = 1; steps == 1 || steps * step.stages <= most_stages; steps *= 2)
    take_better(best, step, {1, processes, steps}, rates);
  return best;
}

std::optional<CutTime> best_blocks(const ClothStep& step, int processes, const ClusterRates& rates,
                                   int most_stages) {
  std::optional<CutTime> best;
  for (int down = 2; 2 * down <= processes; ++down)
    for (int steps = 1; processes % down == 0 && (steps == 1 || steps * step.stages <= most_stages);
         steps *= 2)
      take_better(best, step, {down, processes / down, steps}, rates);
  return best;
}

}  // namespace mssim
