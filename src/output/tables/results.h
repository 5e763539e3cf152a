#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/comparison.h"
#include "bench/results/result.h"
#include "output/tables/table.h"
#include "platform/machine.h"

namespace mssim {

// The files of measured rows.

using RowPointers = std::span<const ResultRow* const>;

std::vector<const ResultRow*> pointers_to(std::span<const ResultRow> rows);

/// A column of a table of rows: its head, and how its cells are made.
struct RowColumn {
  Column head;
  std::function<Cell(const ResultRow&)> value;

  /// A column of timings.csv, under another name too. Throws std::invalid_argument where it has no such
  /// column.
  RowColumn(const char* name) : RowColumn(name, name) {}
  RowColumn(const char* name, std::string_view column);
  RowColumn(Column column, std::function<Cell(const ResultRow&)> cell)
      : head(std::move(column)), value(std::move(cell)) {}
};

std::vector<Column> heads_of(const std::vector<RowColumn>& columns);
std::vector<Cell> cells_of(const ResultRow& row, const std::vector<RowColumn>& columns);

/// A line for each row; without rows there are no columns either.
Table table_of(RowPointers rows, const std::vector<RowColumn>& columns);

/// The columns of timings.csv and a row for each, absent values empty.
Table timings_table(std::span<const ResultRow> rows);

/// timings.csv: numbers read back as they were. Throws std::invalid_argument for a number that is not finite.
std::string timings_csv(std::span<const ResultRow> rows);

/// samples.csv: scene, backend, integrator, round (from 1), steps in the sample and its ms per step, for
/// every sample of every row. Throws like timings_csv().
std::string samples_csv(std::span<const ResultRow> rows);

/// The rows of a timings.csv, without their samples. Further columns behind the known ones are allowed and
/// ignored. Throws CsvError.
std::vector<ResultRow> read_timings(const CsvTable& table);

/// Reads a samples.csv into those of `rows` that it has samples of; others stay as they are.
/// Throws CsvError, also when the rounds of a row do not count up from 1.
void read_samples(const CsvTable& table, std::span<ResultRow> rows);

/// What every version of mssim has written about a combination.
struct CombinationTime {
  std::string scene, backend, integrator;
  /// The least sample's time a step, of what was verified: what else a machine does only ever adds to a
  /// sample, and seldom to all of them.
  std::optional<double> least_ms;
  std::string status;  ///< why there is no time, where there is none
};

/// The rows of a timings.csv that another version of mssim may have written: columns are found by name.
/// Throws CsvError.
std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file);

/// The rows with status "ok" in the schema of Google Benchmark's JSON output (json_schema_version 1), which
/// its tools/compare.py and many services read: a benchmark named SCENE/BACKEND/INTEGRATOR for each row, with
/// one entry a sample and, from two samples on, the aggregates mean, median, stddev and cv.
///
/// real_time is nanoseconds per step and iterations the steps of a sample. The schema demands a cpu_time;
/// the harness measures wall-clock time only, so it is given as real_time again, and `context` says so. The
/// host has no name here. Throws std::invalid_argument for a time that is not finite.
std::string benchmark_json(std::span<const ResultRow> rows, const Provenance& provenance);

/// The rows that are ok as github-action-benchmark reads them from JSON ("customSmallerIsBetter"): name
/// (scene/backend/integrator), unit, value (median) and range (the 95 % interval of the median), with device
/// and threads as `extra`.
Table github_table(std::span<const ResultRow> rows);

// Rows for people.

/// The rows of a bench for a reader, a block for each scene: times with their intervals, whether they are
/// verified, and the speed-up against `serial` as a number and a bar, all bars in one scale. Columns that do
/// not fit the terminal are left out, first what the result folder tells more of, then the bars, then the
/// intervals. Below a block stands why rows have no time. `provenance` tells what was asked
/// for.
std::string row_table(RowPointers rows, const Provenance& provenance, const Terminal& terminal);

/// The rows of a comparison and the geometric means of their ratios.
Document comparison_page(const RunComparison& comparison);

enum class ComparisonFormat { table, markdown, json };

/// A comparison as columns for a terminal, as its page in Markdown, or as one JSON object {threshold,
/// regression, rows, geometric_means}, whose numbers are finite. Ends with a newline. `utf8`: whether columns
/// may hold other characters than those of ASCII.
std::string to_text(const RunComparison& comparison, ComparisonFormat format, bool utf8 = true);

// Tables of results, and what those of measured rows have in common.

/// The TABLE of tables of results, those of guides too: nothing makes another one (TableName), and a result
/// folder that is emptied loses these.
inline constexpr auto table_names = std::to_array<std::string_view>(
    {"table1", "table2", "table3", "races", "scaling", "threads", "peers", "cluster", "figure6", "guide",
     "guide-steps", "guide-errors", "guide-sizes", "guide-frames", "guide-crossovers"});

/// One of these names; another one does not compile.
class TableName {
 public:
  consteval TableName(const char* name) : text_(name) {
    if (std::ranges::find(table_names, text_) == table_names.end()) throw "not in table_names";
  }
  constexpr operator std::string_view() const { return text_; }
  friend constexpr bool operator==(TableName a, std::string_view b) { return a.text_ == b; }

 private:
  std::string_view text_;
};

/// A table of results.
struct ResultTable {
  TableName name;
  Table data;     ///< for programs: the file NAME.csv
  Document page;  ///< for people: the file NAME.md
};

/// Makes tables of the rows that a run has so far; none where no row belongs into one.
using TableMaker =
    std::function<std::vector<ResultTable>(std::span<const ResultRow> rows, const Provenance& provenance)>;

/// The row of a combination; null where there is none.
const ResultRow* find_row(RowPointers rows, std::string_view scene, std::string_view backend,
                          std::string_view integrator);

/// Version, commit and time, without a full stop.
std::string made_by(const Provenance& provenance);

/// One sentence for the top of a page: machine, threads, instruction sets and devices of the rows, program,
/// time.
Paragraph measured_on(RowPointers rows, const Provenance& provenance);

/// The first row of the backend that ran on a device of OpenCL; null where there is none.
const ResultRow* row_with_device(RowPointers rows, std::string_view backend);

/// The name of a backend for a cell; with the OpenCL device that its rows ran on, and whether that is the
/// processor of the machine.
std::string backend_label(RowPointers rows, std::string_view backend, const Provenance& provenance);

/// A device that is not what the backends of the host run on; empty for those.
std::string_view opencl_device(const ResultRow& row);

/// Is the row's device of OpenCL the processor of the machine?
bool is_this_processor(const ResultRow& row, const Provenance& provenance);
/// Is a device of OpenCL?
bool is_this_processor(std::string_view device, const Provenance& provenance);

/// Median milliseconds a step of a row that counts, else none.
std::optional<double> counted_ms(const ResultRow& row);

/// `value`, which was measured; where there is none, the first word of why. Nothing without a row.
Cell measured_cell(const ResultRow* row, const std::optional<double>& value);

/// "0.115 to 0.121"
std::string interval_text(double low, double high);

/// Nanoseconds a node and step of `ms`, which is a time of the row; none where the row does not count.
std::optional<double> ns_per_node(const ResultRow& row, const std::optional<double>& ms);

/// The row's scene with its number of nodes, at the head of numbers.
Column scene_column(const ResultRow& row);

/// " (2.95×)"
std::string in_brackets(double ratio);

/// "†" for a ratio which the times shown beside it contradict: as they are shown, their quotient differs from
/// it by more than a quarter, or says otherwise which of the two is the longer. Else empty. `ratio`: of
/// `time` to `other`, all above zero; the unit of the times does not matter. Tables show medians of times
/// and, beside them, a ratio that was estimated from the single samples: on a machine whose speed changes,
/// the quotient of the medians is another number.
std::string_view mark_of_ratio(double ratio, double time, double other);
/// What stands for it where only ASCII is shown.
inline constexpr std::string_view ascii_ratio_mark = "(?)";

/// That mark of the row's speed-up, its time and that of `serial`.
std::string_view mark_of_speedup(RowPointers rows, const ResultRow& row);

/// What that mark means; empty where no cell has it, and no letter of a table that is text already.
std::string legend_of_ratios(const Table& table);
std::string legend_of_ratios(const Document& page);
std::string legend_of_ratios(std::string_view table);

/// What stands behind the number of threads, or the time, of a row that took more processors than
/// it was asked to; nothing of others.
std::string_view mark_of_excess(const ResultRow& row, const Provenance& provenance);

/// What that mark means, and which backends have it; empty where none has.
std::string legend_of_excess(RowPointers rows, const Provenance& provenance);

/// A ratio and its interval.
struct RatioInterval {
  double ratio = 1;
  double low = 1, high = 1;

  /// 1 where it lies above 1, -1 where it lies below, and 0 where it holds 1.
  int side_of_one() const { return low > 1 ? 1 : high < 1 ? -1 : 0; }
};

/// How many times as fast as `than` a row is: the median of the ratios within each round, with its 95 %
/// interval (statistics.h). Where their samples are no pairs: the quotient of the times, and of the ends of
/// their intervals, which is wider. None where one of them does not count, or is null.
std::optional<RatioInterval> times_as_fast(const ResultRow* row, const ResultRow* than);

/// Why a table shows no speed-ups, and what to do, where serial is not one of the backends; else empty.
std::string reason_without_speedups(std::span<const std::string_view> backends);
std::string reason_without_speedups(RowPointers rows);

/// Adds the last section of a page: what became of those of the rows that do not count, one item for each
/// reason with the scenes that it holds for. Nothing where all count.
void add_rows_without_a_time(Document& page, RowPointers rows);

}  // namespace mssim
