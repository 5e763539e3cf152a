#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/results/result.h"
#include "output/tables/table.h"

namespace mssim {

/// The columns of timings.csv and a row for each, absent values empty.
Table timings_table(std::span<const ResultRow> rows);

/// timings.csv: a header and one line per row, absent values empty. Numbers read back as they were.
/// Throws std::invalid_argument for a number that is not finite.
std::string timings_csv(std::span<const ResultRow> rows);

/// samples.csv: scene, backend, integrator, round (from 1), steps in the sample and its ms per step, for
/// every sample of every row. Throws like timings_csv().
std::string samples_csv(std::span<const ResultRow> rows);

/// The rows of a timings.csv, without their samples. Further columns behind the known ones are allowed and
/// ignored. Throws CsvError.
std::vector<ResultRow> read_timings(const CsvTable& table);
std::vector<ResultRow> read_timings(const std::filesystem::path& file);

/// Reads a samples.csv into those of `rows` that it has samples of; others stay as they are.
/// Throws CsvError, also when the rounds of a row do not count up from 1.
void read_samples(const CsvTable& table, std::span<ResultRow> rows);
void read_samples(const std::filesystem::path& file, std::span<ResultRow> rows);

}  // namespace mssim
