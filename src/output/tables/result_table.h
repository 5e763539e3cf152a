#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"

namespace mssim {

/// A table that is made of measured rows, for the files NAME.csv and NAME.md.
struct ResultTable {
  std::string name;
  std::string csv;
  std::string markdown;
};

/// Every name of such a table, and table2, which is made of what the scenes are.
inline constexpr std::array<std::string_view, 6> table_names{"table1", "table2",  "table3",
                                                             "races",  "scaling", "figure6"};

/// Makes tables of the rows that a run has so far; none where no row belongs into one.
using TableMaker =
    std::function<std::vector<ResultTable>(std::span<const ResultRow> rows, const Provenance& provenance)>;

/// What tables of measured rows have in common.

/// One sentence for the top of a Markdown file: machine, threads, devices of the rows, program, time. Ends
/// with a blank line.
std::string measured_on(std::span<const ResultRow* const> rows, const Provenance& provenance);

/// What stands behind the number of threads, or the time, of a row that took more processors than `threads`,
/// which were asked for; nothing of others.
std::string_view mark_of_excess(const ResultRow& row, int threads);

/// What that mark means, and which backends have it; empty where none has.
std::string legend_of_excess(std::span<const ResultRow* const> rows, int threads);

/// Why a table shows no speed-ups, and what to do, where serial is not one of the backends; else empty.
std::string reason_without_speedups(std::span<const std::string_view> backends);
std::string reason_without_speedups(std::span<const ResultRow* const> rows);

/// A paragraph of a Markdown file with this sentence, after what stands before; empty without one.
std::string paragraph(const std::string& sentence);

/// The last section of a Markdown file: what became of those of the rows that do not count, one line for each
/// reason with the scenes that it holds for. Empty where all count.
std::string rows_without_a_time(std::span<const ResultRow* const> rows);

}  // namespace mssim
