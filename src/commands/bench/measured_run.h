#pragma once

#include <filesystem>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"

namespace mssim {

/// What `mssim bench --out` left in a folder.
struct MeasuredRun {
  Provenance provenance;
  std::vector<ResultRow> rows;  ///< those that are ok have samples
};

/// Reads a result folder, named by itself or by a file in it. Throws UsageError when there is none or its
/// samples are not those of its rows, CsvError and ProvenanceError for files that cannot be read.
MeasuredRun read_run(const std::filesystem::path& path);

}  // namespace mssim
