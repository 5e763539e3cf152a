#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/provenance.h"
#include "bench/result.h"

namespace mssim {

/// A table that is made of measured rows, for the files NAME.csv and NAME.md.
struct ResultTable {
  std::string name;
  std::string csv;
  std::string markdown;
};

/// Makes tables of the rows that a run has so far; none where no row belongs into one.
using TableMaker =
    std::function<std::vector<ResultTable>(std::span<const ResultRow> rows, const Provenance& provenance)>;

/// What tables of measured rows have in common.

/// One sentence for the top of a Markdown file: machine, threads, devices of the rows, program, time. Ends
/// with a blank line.
std::string measured_on(std::span<const ResultRow* const> rows, const Provenance& provenance);

/// The last section of a Markdown file: what became of those of the rows that do not count, one line for each
/// reason with the scenes that it holds for. Empty where all count.
std::string rows_without_a_time(std::span<const ResultRow* const> rows);

}  // namespace mssim
