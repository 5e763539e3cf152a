#include "bench/results/history.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "application/bench/bench_results.h"
#include "application/console.h"
#include "commands/command.h"
#include "commands/options.h"
#include "output/folders/history_file.h"
#include "output/tables/results.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

struct HistoryOptions {
  std::string action, folder;
  std::string file = "history.jsonl";
  std::string commit;
  bool replace = false;
  std::optional<double> threshold_percent;
  std::optional<int> last;
  ListingFormat format = ListingFormat::table;
};

int add(const HistoryOptions& options) {
  if (options.folder.empty())
    throw UsageError("FOLDER is missing: give the folder that mssim bench --out wrote");
  refuse_options("history add", {{"--threshold", options.threshold_percent.has_value()},
                                 {"--last", options.last.has_value()},
                                 {"--format", options.format != ListingFormat::table}});
  const MeasuredRun run = read_run(options.folder);
  tell_unchecked_samples(run.rows, options.folder);
  // As it reads back: the entries that it is compared with have been cut and escaped.
  const std::string line = history_line(entry_of(run.provenance, run.rows, options.commit));
  std::size_t entries = 0;
  change_history(options.file, [&](std::vector<HistoryEntry>& history) {
    add_entry(history, parse_history(options.folder, line).front(), options.replace);
    entries = history.size();
  });
  tell("{} has {}", printable(options.file), entries == 1 ? "1 entry" : fmt::format("{} entries", entries));
  return exit_ok;
}

/// The tables of all machines: for a terminal each below the machine's name, else in one, with the name as
/// the first column.
std::string to_text(const std::vector<MachineHistory>& machines, double threshold, ListingFormat format) {
  std::string text;
  Table all;
  for (const MachineHistory& machine : machines) {
    Table table = history_table(machine, threshold);
    text += fmt::format("{}{}: {}\n{}", text.empty() ? "" : "\n", machine.name,
                        pluralize(machine.entries.size(), "commit"), to_text(table, ListingFormat::table));
    for (std::vector<Cell>& row : table.rows) row.insert(row.begin(), machine.name);
    if (all.columns.empty()) {
      all.columns = std::move(table.columns);
      all.columns.insert(all.columns.begin(), Column{"machine"});
    }
    std::ranges::move(table.rows, std::back_inserter(all.rows));
  }
  return format == ListingFormat::table ? text : to_text(all, format);
}

int show(const HistoryOptions& options) {
  if (!options.folder.empty())
    throw UsageError("show takes no FOLDER, but was given {}: give the file with --file",
                     printable(options.folder));
  refuse_options("history show", {{"--commit", !options.commit.empty()}, {"--replace", options.replace}});
  const std::vector<HistoryEntry> history = read_history(options.file);
  const std::vector<MachineHistory> machines = machines_of(history);
  const double threshold = options.threshold_percent.value_or(5) / 100;
  std::cout << to_text(machines, threshold, options.format);
  std::vector<std::string> sentences;
  for (const MachineHistory& machine : machines)
    std::ranges::move(regressions(machine, threshold, static_cast<std::size_t>(options.last.value_or(10))),
                      std::back_inserter(sentences));
  tell_first(sentences);
  return sentences.empty() ? exit_ok : exit_regression;
}

}  // namespace

std::function<int()> declare_history(Arguments& arguments) {
  const auto options = std::make_shared<HistoryOptions>();
  arguments
      .add("ACTION", options->action,
           "add: append a result folder to the file; show: list levels and changes of every series",
           one_of("action", {"add", "show"}))
      .required();
  arguments.add("FOLDER FOLDER|FILE", options->folder,
                "With add: a folder that mssim bench --out wrote, or a file in it");
  arguments.add("--file FILE", options->file, "The history, a JSON object per line (default: history.jsonl)");
  arguments.add("--commit TEXT", options->commit,
                "With add: the commit that was measured (default: that of mssim's source)");
  arguments.add_flag("--replace", options->replace,
                     "With add: replace the entry of the same commit and machine");
  arguments.add_number("--threshold PERCENT", options->threshold_percent,
                       "With show: smallest slowdown that counts, in percent (default: 5)",
                       positive_number());
  arguments.add_number("--last N", options->last,
                       "With show: slowdowns and vanished rows count in the last N commits of a machine "
                       "(default: 10)",
                       whole_number(1, 1000000));
  declare_listing_format(arguments, options->format);
  return [options] { return options->action == "add" ? add(*options) : show(*options); };
}

}  // namespace mssim
