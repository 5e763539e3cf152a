#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "statistics/statistics.h"

namespace mssim {

/// Times of many commits, measured one after the other, and the changes in them. A file keeps the entries
/// (output/folders/history_file.h); a machine's times are never compared with another machine's.

/// Times are compared only if they are of the same combination, device and size of the scene.
struct HistoryCombination : CombinationNames {
  std::string device;
  std::uint32_t nodes = 0;
};

/// What an entry keeps of a row.
struct HistoryRow : HistoryCombination {
  /// The median of the samples with its interval; none unless the row counts().
  std::optional<double> ms_per_step, ms_per_step_low, ms_per_step_high;
  std::uint32_t samples = 0;
  bool verified = false;
};

/// One result folder. Entries are in the order in which they were measured.
struct HistoryEntry {
  std::string commit;       ///< of the repository whose history it is
  std::string started_utc;  ///< ISO 8601
  std::string processor;    ///< cpu_name()
  std::uint32_t logical_cpus = 0, threads = 0;
  std::string program;  ///< mssim's version and how it was built
  std::vector<HistoryRow> rows;
};

/// Name of the machine: processor, logical CPUs and threads.
std::string machine_of(const HistoryEntry& entry);

/// An entry of a run. Without a `commit`, that of the program, which ends in ", changed" if its sources
/// differed from it. Throws UsageError for no rows, and for a program of an unknown commit.
HistoryEntry entry_of(const Provenance& provenance, std::span<const ResultRow> rows,
                      const std::string& commit = {});

/// Appends the entry. If the history has one of this commit and machine, the new one takes its place if
/// `replace`; else throws UsageError.
void add_entry(std::vector<HistoryEntry>& history, HistoryEntry entry, bool replace);

/// Times of a combination on a machine, in the order of its entries.
struct HistorySeries : HistoryCombination {
  std::vector<std::size_t> at;    ///< [times] the machine's entry
  std::vector<double> ms;         ///< [times]
  std::vector<double> low, high;  ///< [times] its 95 % interval; the time itself if it has none
  std::vector<ChangePoint> changes;
  /// The first of the machine's latest entries that have no verified time of it; none if the last one has.
  std::optional<std::size_t> vanished;

  /// The times from one change to the next. Level 0 ends at changes[0], the last one at the end.
  std::span<const double> level(std::size_t number) const;
};

/// The entries of one machine: a processor with a number of logical CPUs, used with a number of threads.
struct MachineHistory {
  std::string name;
  std::vector<const HistoryEntry*> entries;
  std::vector<HistorySeries> series;

  /// Whether that is one of the last `count` entries.
  bool is_recent(std::size_t entry, std::size_t count) const { return entry + count >= entries.size(); }
};

/// The machines, in the order of their first entries, with the changes of each series. They refer to the
/// history.
std::vector<MachineHistory> machines_of(std::span<const HistoryEntry> history);

/// How a ratio of times is judged: "slower" or "faster" beyond the threshold, a fraction; else "within N %".
std::string judged(const RatioEstimate& ratio, double threshold);

/// A sentence for each series of the machine that vanished in one of the last `count` entries, or became
/// slower in them: its last level is slower, beyond the threshold, than the fastest of those that ended in
/// these entries. The sentence names the commit that ended the fastest level.
std::vector<std::string> regressions(const MachineHistory& machine, double threshold, std::size_t count);

}  // namespace mssim
