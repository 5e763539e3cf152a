#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/tables/table.h"

namespace mssim {

/// A table that is made of measured rows.
struct ResultTable {
  std::string name;
  Table data;     ///< for programs: the file NAME.csv
  Document page;  ///< for people: the file NAME.md
};

/// Every name of such a table, and table2, which is made of what the scenes are.
inline constexpr std::array<std::string_view, 15> table_names{"table1",       "table2",
                                                              "table3",       "races",
                                                              "scaling",      "peers",
                                                              "cluster",      "cluster-estimates",
                                                              "figure6",      "guide",
                                                              "guide-steps",  "guide-sizes",
                                                              "guide-frames", "guide-crossovers",
                                                              "guide-errors"};

/// Makes tables of the rows that a run has so far; none where no row belongs into one.
using TableMaker =
    std::function<std::vector<ResultTable>(std::span<const ResultRow> rows, const Provenance& provenance)>;

/// What tables of measured rows have in common.
using RowPointers = std::span<const ResultRow* const>;

std::vector<const ResultRow*> pointers_to(std::span<const ResultRow> rows);

/// The row of a combination; null where there is none.
const ResultRow* find_row(RowPointers rows, std::string_view scene, std::string_view backend,
                          std::string_view integrator);

/// Version, commit and time, without a full stop.
std::string made_by(const Provenance& provenance);

/// One sentence for the top of a page: machine, threads, instruction sets and devices of the rows, program,
/// time.
Paragraph measured_on(RowPointers rows, const Provenance& provenance);

/// The name of a backend for a cell; with the OpenCL device that its rows ran on, and whether that is the
/// processor of the machine.
std::string backend_label(RowPointers rows, std::string_view backend, const Provenance& provenance);

/// What the row's backend computed with on the host, where it chose among instruction sets ("AVX3"); else
/// empty.
std::string_view instruction_set(const ResultRow& row);

/// A device that is not what the backends of the host run on; empty for those.
std::string_view opencl_device(const ResultRow& row);

/// `value`, which was measured; where there is none, the first word of why. Nothing without a row.
Cell measured_cell(const ResultRow* row, const std::optional<double>& value);

/// Nanoseconds a node and step of `ms`, which is a time of the row; none where the row does not count.
std::optional<double> ns_per_node(const ResultRow& row, const std::optional<double>& ms);

/// The row's scene with its number of nodes, at the head of numbers.
Column scene_column(const ResultRow& row);

/// " (2.95×)"
std::string in_brackets(double ratio);

/// "†" where the row's speed-up contradicts its time and that of `serial` (ratio_mark.h); else empty.
std::string_view mark_of_speedup(RowPointers rows, const ResultRow& row);

/// What stands behind the number of threads, or the time, of a row that took more processors than
/// it was asked to; nothing of others.
std::string_view mark_of_excess(const ResultRow& row, const Provenance& provenance);

/// What that mark means, and which backends have it; empty where none has.
std::string legend_of_excess(RowPointers rows, const Provenance& provenance);

/// Why a table shows no speed-ups, and what to do, where serial is not one of the backends; else empty.
std::string reason_without_speedups(std::span<const std::string_view> backends);
std::string reason_without_speedups(RowPointers rows);

/// Adds the last section of a page: what became of those of the rows that do not count, one item for each
/// reason with the scenes that it holds for. Nothing where all count.
void add_rows_without_a_time(Document& page, RowPointers rows);

}  // namespace mssim
