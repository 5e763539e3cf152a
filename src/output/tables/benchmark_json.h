#pragma once

#include <span>
#include <string>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"

namespace mssim {

/// The rows with status "ok" in the schema of Google Benchmark's JSON output (json_schema_version 1), which
/// its tools/compare.py and many services read: a benchmark named SCENE/BACKEND/INTEGRATOR for each row, with
/// one entry a sample and, from two samples on, the aggregates mean, median, stddev and cv.
///
/// real_time is nanoseconds per step and iterations the steps of a sample. The schema demands a cpu_time;
/// the harness measures wall-clock time only, so it is given as real_time again, and `context` says so. The
/// host has no name here. Throws std::invalid_argument for a time that is not finite.
std::string benchmark_json(std::span<const ResultRow> rows, const Provenance& provenance);

}  // namespace mssim
