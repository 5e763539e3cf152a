#include <algorithm>

#include "output/tables/results.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A commit's hash in as many digits as usual.
std::string short_commit(const std::string& commit) {
  constexpr std::size_t digits = 12, all_digits = 40;
  const bool is_hash =
      commit.size() >= all_digits && commit.find_first_not_of("0123456789abcdef") >= all_digits;
  return is_hash ? commit.substr(0, digits) + commit.substr(all_digits) : commit;
}

}  // namespace

Table history_table(const MachineHistory& machine, double threshold) {
  Table table;  // with columns also without a series
  for (const char* name : {"scene", "backend", "integrator", "device", "nodes", "since", "commits", "ms",
                           "ratio", "low", "high", "verdict"})
    table.columns.push_back({name});
  for (const HistorySeries& series : machine.series) {
    const auto add = [&](std::size_t entry, Cell count, Cell ms, const RatioEstimate* ratio,
                         const std::string& verdict) {
      table.rows.push_back(
          {series.scene, series.backend, series.integrator, series.device, series.nodes,
           short_commit(machine.entries[entry]->commit), std::move(count), std::move(ms),
           ratio ? Cell(ratio->ratio) : Cell(), ratio && ratio->covers ? Cell(ratio->low) : Cell(),
           ratio && ratio->covers ? Cell(ratio->high) : Cell(), verdict.empty() ? Cell() : Cell(verdict)});
    };
    for (std::size_t level = 0; level <= series.changes.size(); ++level) {
      const ChangePoint* change = level == 0 ? nullptr : &series.changes[level - 1];
      const std::span<const double> times = series.level(level);
      add(series.at[change ? change->first : 0], times.size(), median(times),
          change ? &change->ratio : nullptr, change ? judged(change->ratio, threshold) : "");
    }
    if (series.vanished) add(*series.vanished, {}, {}, nullptr, "vanished");
  }
  return table;
}

}  // namespace mssim
