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
#include "bench/results/history.h"
#include "bench/results/result.h"
#include "output/tables/table.h"
#include "platform/machine.h"

namespace mssim {

// Files of measured rows.

/// Rows of a table, by address.
using RowPointers = std::span<const ResultRow* const>;

/// The addresses of the rows, which must outlive them.
std::vector<const ResultRow*> pointers_to(std::span<const ResultRow> rows);

/// The columns of timings.csv and a line for each row; missing values are empty.
Table timings_table(std::span<const ResultRow> rows);

/// The columns that mssim bench prints for programs, and a line for each row; without rows, no columns.
Table printed_table(RowPointers rows);

/// The JSON Schemas of these two tables, committed as docs/schemas/timings.schema.json and bench.schema.json.
std::string timings_schema();
std::string bench_schema();

/// timings.csv; numbers read back unchanged. Throws std::invalid_argument for a number that is not finite.
std::string timings_csv(std::span<const ResultRow> rows);

/// samples.csv: scene, backend, integrator, round (from 1), steps of the sample and its ms per step, for
/// every sample of every row. Throws like timings_csv().
std::string samples_csv(std::span<const ResultRow> rows);

/// The rows of a timings.csv, without samples. Additional columns after the known ones are ignored. Throws
/// CsvError.
std::vector<ResultRow> read_timings(const CsvTable& table);

/// Reads the samples in a samples.csv into `rows`; rows without samples there stay unchanged. Throws
/// CsvError, also if the rounds of a row do not count up from 1.
void read_samples(const CsvTable& table, std::span<ResultRow> rows);

/// The part of a result that every version of mssim has written.
struct CombinationTime : CombinationNames {
  /// Time per step of the least sample, if verified. Disturbances only make a sample longer, and seldom
  /// affect all.
  std::optional<double> least_ms;
  std::string status;  ///< why there is no time, if there is none
};

/// The rows of a timings.csv from any version of mssim: columns are found by name. Throws CsvError.
std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file);

/// The rows with status "ok" in the schema of Google Benchmark's JSON output (json_schema_version 1), which
/// its tools/compare.py and many services read: for each row a benchmark named SCENE/BACKEND/INTEGRATOR, with
/// one entry per sample and, from two samples on, the aggregates mean, median, stddev and cv.
///
/// real_time is nanoseconds per step and iterations the steps of a sample. The schema requires a cpu_time;
/// the harness measures only wall-clock time, so it repeats real_time, and `context` says so. The host is not
/// named. Throws std::invalid_argument for a time that is not finite.
std::string benchmark_json(std::span<const ResultRow> rows, const Provenance& provenance);

/// The rows that are ok in github-action-benchmark's JSON ("customSmallerIsBetter"): name
/// (scene/backend/integrator), unit, value (median) and range (the 95 % interval of the median; empty with
/// too few rounds for one), with device and threads as `extra`.
Table github_table(std::span<const ResultRow> rows);

// Rows for people.

/// The rows of a bench for a reader, one block per scene: times with intervals, verification, and the
/// speed-up against `serial` as a number and a bar; all bars have one scale. Columns that do not fit the
/// terminal are left out: first those that the result folder shows in more detail, then the bars, then the
/// intervals. Reasons for missing times follow each block. `provenance` has the requested threads.
std::string row_table(RowPointers rows, const Provenance& provenance, const Terminal& terminal);

/// The rows of a comparison and the geometric means of their ratios.
Document comparison_page(const RunComparison& comparison);

/// Format of a printed comparison.
enum class ComparisonFormat { table, markdown, json };

/// A comparison as columns for a terminal, as its page in Markdown, or as one JSON object {threshold,
/// regression, rows, geometric_means} with finite numbers. Ends with a newline. `utf8`: whether columns may
/// have characters outside ASCII.
std::string to_text(const RunComparison& comparison, ComparisonFormat format, bool utf8 = true);

/// The levels of each series of a machine's history, with its device as it was recorded: the first commit of
/// each level, the number of commits, the median of their times in ms, the ratio to the level before with its
/// 95 % interval, if there are enough commits for one, and the verdict. A series that vanished has a row
/// without a time.
Table history_table(const MachineHistory& machine, double threshold);

// Tables of results, and helpers of tables of measured rows.

/// The TABLE of tables of results, including those of guides. Every table has one of these names (TableName),
/// and they are removed when a result folder is emptied.
inline constexpr auto table_names = std::to_array<std::string_view>(
    {"table1", "table2", "table3", "races", "scaling", "threads", "peers", "cluster", "figure6", "guide",
     "guide-steps", "guide-errors", "guide-sizes", "guide-frames", "guide-crossovers"});

/// One of these names; any other name does not compile.
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

/// Makes tables from a run's rows so far; none if no row belongs in one.
using TableMaker =
    std::function<std::vector<ResultTable>(std::span<const ResultRow> rows, const Provenance& provenance)>;

/// The row of a combination; null if there is none.
const ResultRow* find_row(RowPointers rows, std::string_view scene, std::string_view backend,
                          std::string_view integrator);

/// The row that this one is compared with, is_baseline(), of its scene and integrator; null if there is none.
const ResultRow* baseline_of(RowPointers rows, const ResultRow& row);

/// Version, commit and time, without a full stop.
std::string made_by(const Provenance& provenance);

/// One sentence for the top of a page: machine, threads, instruction sets and devices of the rows, program
/// and time.
Paragraph measured_on(RowPointers rows, const Provenance& provenance);

/// The first row of the backend that ran on an OpenCL device; null if there is none.
const ResultRow* row_with_device(RowPointers rows, std::string_view backend);

/// The name of a backend in a cell. Adds the OpenCL device of its rows, if any, and whether that is the
/// machine's processor.
std::string backend_label(RowPointers rows, std::string_view backend, const Provenance& provenance);

/// The row's OpenCL device; empty for backends of the host.
std::string_view opencl_device(const ResultRow& row);

/// Whether an OpenCL device, by its name, is the machine's processor.
bool is_this_processor(std::string_view device, const Provenance& provenance);

/// Median ms per step of a row that counts, otherwise none.
std::optional<double> counted_ms(const ResultRow& row);

/// `value`, which was measured, or the first word of the reason for its absence. Empty without a row.
Cell measured_cell(const ResultRow* row, const std::optional<double>& value);

/// "0.115 to 0.121"
std::string interval_text(double low, double high);
/// The 95 % interval of the row's time; empty if the row does not count, or has none.
Cell interval_cell(const ResultRow& row);

/// ns per node and step for `ms`, a time of the row; none if the row does not count.
std::optional<double> ns_per_node(const ResultRow& row, const std::optional<double>& ms);

/// A column with the row's scene and number of nodes as heading.
Column scene_column(const ResultRow& row);

/// " (2.95×)"
std::string in_brackets(double ratio);

/// "†" if the times shown next to a ratio contradict it: their quotient, as shown, differs from it by more
/// than a quarter, or names the other one as the longer. Otherwise empty. `ratio`: of `time` to `other`, all
/// above zero; the unit of the times does not matter. Tables show medians of times next to a ratio that was
/// estimated from single samples; on a machine whose speed changes, the quotient of the medians differs from
/// it.
std::string_view mark_of_ratio(double ratio, double time, double other);
/// The mark if only ASCII is shown.
inline constexpr std::string_view ascii_ratio_mark = "(?)";

/// mark_of_ratio() of the row's speed-up, its time and the time of `serial`.
std::string_view mark_of_speedup(RowPointers rows, const ResultRow& row);

/// The meaning of that mark; empty if no cell has it or, for a text, if it does not occur.
std::string legend_of_ratios(const Document& page);
std::string legend_of_ratios(std::string_view table);

/// A mark after the number of threads, or the time, of a row that used more processors than requested;
/// otherwise empty.
std::string_view mark_of_excess(const ResultRow& row, const Provenance& provenance);

/// The meaning of that mark, and the backends that have it; empty if none has.
std::string legend_of_excess(RowPointers rows, const Provenance& provenance);

/// A ratio and its interval.
struct RatioInterval {
  double ratio = 1;
  double low = 1, high = 1;
  /// Whether that is a 95 % interval. If not, too few rounds were measured, and it decides nothing.
  bool covers = false;

  /// 1 if the ratio is certainly above `limit`, -1 if certainly below, and 0 if that is not known.
  int side_of(double limit) const { return !covers ? 0 : low > limit ? 1 : high < limit ? -1 : 0; }
};

/// A ratio of the times of two rows, with mark_of_ratio(); empty without one.
Cell ratio_cell(const std::optional<RatioInterval>& ratio, const ResultRow* time, const ResultRow* other);

/// The 95 % interval of a ratio; empty without one.
Cell ratio_interval_cell(const std::optional<RatioInterval>& ratio);

/// Speed-up of a row over `than`: the median of the ratios within each round, with its 95 % interval
/// (statistics.h). If their samples are not pairs: the quotient of the times and of the ends of their
/// intervals, which is wider; `covers` then follows from their rounds. None if one of them does not count or
/// is null.
std::optional<RatioInterval> times_as_fast(const ResultRow* row, const ResultRow* than);

/// Why a table has no speed-ups, and the remedy, if serial is not one of the backends; otherwise empty.
std::string reason_without_speedups(std::span<const std::string_view> backends);
std::string reason_without_speedups(RowPointers rows);

/// Adds the last section of a page: the rows that do not count, one item per reason with its scenes. Nothing
/// if all count.
void add_rows_without_a_time(Document& page, RowPointers rows);

}  // namespace mssim
