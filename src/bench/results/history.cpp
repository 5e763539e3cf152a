#include "bench/results/history.h"

#include <algorithm>

#include "platform/machine.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

std::string machine_of(const HistoryEntry& entry) {
  return fmt::format("{}, {}, {}", entry.processor, pluralize(entry.logical_cpus, "logical CPU"),
                     pluralize(entry.threads, "thread"));
}

namespace {

/// Adds the rows of the machine's last entry to its series.
void add_rows(MachineHistory& machine) {
  for (const HistoryRow& row : machine.entries.back()->rows) {
    if (!row.verified || !row.ms_per_step) continue;
    auto series = std::ranges::find_if(machine.series, [&](const HistorySeries& known) {
      return same_combination(known, row) && known.device == row.device && known.nodes == row.nodes;
    });
    if (series == machine.series.end())
      series = machine.series.insert(
          series, HistorySeries{{static_cast<const HistoryCombination&>(row)}, {}, {}, {}, {}, {}, {}});
    series->at.push_back(machine.entries.size() - 1);
    series->ms.push_back(*row.ms_per_step);
    const bool covers = has_interval(row.samples);
    series->low.push_back(covers ? row.ms_per_step_low.value_or(*row.ms_per_step) : *row.ms_per_step);
    series->high.push_back(covers ? row.ms_per_step_high.value_or(*row.ms_per_step) : *row.ms_per_step);
  }
}

}  // namespace

HistoryEntry entry_of(const Provenance& provenance, std::span<const ResultRow> rows,
                      const std::string& commit) {
  const BuildInfo& build = provenance.build;
  if (commit.empty() && !knows_commit(build))
    throw UsageError(
        "the program that measured was built outside a git repository: name the commit with --commit");
  if (rows.empty())
    throw UsageError("timings.csv has no rows: give a folder in which something was measured");
  HistoryEntry entry{commit.empty() ? build.commit + (build.dirty ? ", changed" : "") : commit,
                     provenance.started_utc,
                     cpu_name(provenance.machine),
                     static_cast<std::uint32_t>(provenance.machine.logical_cpus),
                     static_cast<std::uint32_t>(provenance.threads),
                     fmt::format("mssim {}, {}, {}", build.version, build.compiler, build.build_type),
                     {}};
  for (const ResultRow& row : rows) {
    HistoryRow& kept = entry.rows.emplace_back();
    static_cast<CombinationNames&>(kept) = static_cast<const CombinationNames&>(row);
    kept.device = row.device;
    kept.nodes = static_cast<std::uint32_t>(row.nodes);
    kept.verified = row.verified;
    kept.samples = static_cast<std::uint32_t>(row.samples_ms.size());
    if (!counts(row)) continue;
    kept.ms_per_step = row.ms_per_step;
    kept.ms_per_step_low = row.ms_per_step_low;
    kept.ms_per_step_high = row.ms_per_step_high;
  }
  return entry;
}

void add_entry(std::vector<HistoryEntry>& history, HistoryEntry entry, bool replace) {
  const auto known = std::ranges::find_if(history, [&](const HistoryEntry& other) {
    return other.commit == entry.commit && machine_of(other) == machine_of(entry);
  });
  if (known == history.end())
    history.push_back(std::move(entry));
  else if (replace)
    *known = std::move(entry);
  else
    throw UsageError(
        "the history has commit {} on {} already, measured {}: keep that, or give --replace to put this "
        "folder in its place",
        printable(entry.commit), printable(machine_of(entry)), known->started_utc);
}

std::vector<MachineHistory> machines_of(std::span<const HistoryEntry> history) {
  std::vector<MachineHistory> machines;
  for (const HistoryEntry& entry : history) {
    const std::string name = machine_of(entry);
    auto machine = std::ranges::find(machines, name, &MachineHistory::name);
    if (machine == machines.end()) machine = machines.insert(machine, MachineHistory{name, {}, {}});
    machine->entries.push_back(&entry);
    add_rows(*machine);
  }
  std::vector<HistorySeries*> all;
  for (MachineHistory& machine : machines)
    for (HistorySeries& series : machine.series) {
      all.push_back(&series);
      if (series.at.back() + 1 < machine.entries.size()) series.vanished = series.at.back() + 1;
    }
    // No time is refused: they are above zero (shortest_ms).
#pragma omp parallel for num_threads(openmp_team(0)) schedule(dynamic)
  for (std::size_t i = 0; i < all.size(); ++i) all[i]->changes = change_points(all[i]->ms);
  return machines;
}

std::span<const double> HistorySeries::level(std::size_t number) const {
  const std::size_t first = number == 0 ? 0 : changes[number - 1].first;
  const std::size_t end = number < changes.size() ? changes[number].first : ms.size();
  return std::span(ms).subspan(first, end - first);
}

std::string judged(const RatioEstimate& ratio, double threshold) {
  if (ratio.ratio > 1 + threshold) return "slower";
  if (ratio.ratio < 1 / (1 + threshold)) return "faster";
  return fmt::format("within {:.6g} %", 100 * threshold);
}

namespace {

/// A slowdown of a series, and the change with which it began.
struct Slowdown {
  const ChangePoint* began = nullptr;
  RatioEstimate ratio;
};

/// The last level against the fastest of those that ended in one of the last `count` entries of the machine:
/// a slowdown in several steps counts as a whole, and one that was repaired does not. None without such a
/// level.
std::optional<Slowdown> slowdown_of(const HistorySeries& series, const MachineHistory& machine,
                                    std::size_t count) {
  const std::size_t last = series.changes.size();
  std::optional<std::size_t> fastest;
  for (std::size_t level = 0; level < last; ++level)
    if (machine.is_recent(series.at[series.changes[level].first], count) &&
        (!fastest || median(series.level(level)) < median(series.level(*fastest))))
      fastest = level;
  if (!fastest) return std::nullopt;
  return Slowdown{&series.changes[*fastest], ratio_of(series.level(*fastest), series.level(last))};
}

}  // namespace

std::vector<std::string> regressions(const MachineHistory& machine, double threshold, std::size_t count) {
  std::vector<std::string> sentences;
  for (const HistorySeries& series : machine.series) {
    const auto tell = [&](std::size_t entry, std::string_view what) {
      if (machine.is_recent(entry, count))
        sentences.push_back(fmt::format("{}: {} (on {})", combination_name(series), what, machine.name));
    };
    if (series.vanished) {
      const HistoryEntry& entry = *machine.entries[*series.vanished];
      const bool moved = std::ranges::any_of(entry.rows, [&](const HistoryRow& row) {
        return same_combination(series, row) && row.verified && row.ms_per_step;
      });
      tell(*series.vanished,
           moved ? fmt::format("on another device, or with other nodes, since commit {}; its times are not "
                               "compared with those before",
                               entry.commit)
                 : fmt::format(
                       "without a verified time since commit {}; measure it again, or see why it failed",
                       entry.commit));
    }
    const std::optional<Slowdown> slowdown = slowdown_of(series, machine, count);
    if (!slowdown || judged(slowdown->ratio, threshold) != "slower") continue;
    const auto& [began, ratio] = *slowdown;
    tell(series.at[began->first],
         fmt::format("slower since commit {}, {:.3g} times the time{}",
                     machine.entries[series.at[began->first]]->commit, ratio.ratio,
                     ratio.covers ? fmt::format(" ({:.3g} to {:.3g})", ratio.low, ratio.high) : ""));
  }
  return sentences;
}

}  // namespace mssim
