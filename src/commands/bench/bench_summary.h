#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bench/results/result.h"
#include "output/tables/structure_table.h"
#include "platform/machine.h"

namespace mssim {

/// How a bench prints its rows; `github` is github_table().
enum class SummaryFormat : std::uint8_t { table, csv, json, github };

/// The rows for a reader: the columns that answer "how fast, how right". As a table (row_table) they are
/// written for `terminal`, with what is to know of the numbers below. `provenance` tells what was asked for.
/// Ends with a newline; empty for a table without rows.
std::string summary(std::span<const ResultRow> rows, SummaryFormat format, const Provenance& provenance,
                    const Terminal& terminal);

/// The rows of scenes of which only the structure is told; none in the format `github`, which is for times.
std::string summary(std::span<const StructureRow> rows, SummaryFormat format);

}  // namespace mssim
