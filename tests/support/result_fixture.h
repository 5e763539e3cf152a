#pragma once

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "tests/support/testing.h"

namespace mssim {

/// The change that matters, as a fraction, in tests of comparisons.
inline constexpr double threshold = 0.05;

/// A row with a number in every column and three samples.
inline ResultRow measured_row(const std::string& backend, double ms, std::optional<double> speedup) {
  ResultRow row;
  row.scene = "cloth2500";
  row.nodes = 2500;
  row.springs_unique = 14502;
  row.springs_published = 29004;
  row.backend = backend;
  row.device = "cpu";
  row.threads = 2;
  row.integrator = "semi-euler";
  row.dt_s = 0.0005;
  row.rounds = 3;
  row.ms_per_step = ms;
  row.ms_per_step_low = ms / 2;
  row.ms_per_step_high = 2 * ms;
  row.ms_per_step_min = ms / 2;
  row.springs_per_second = 14502 / (ms * 1e-3);
  row.gigabytes_per_second = 1.5;
  row.roofline_fraction = 0.25;
  row.speedup_vs_serial = speedup;
  row.paper_ms = 19.475;
  row.position_error = 1e-5;
  row.energy_drift = -2e-7;
  row.state_hash = 0x0123456789abcdef;
  row.processors_used = 1.5;
  row.waiting_share = 0.0625;
  row.packing_share = 0.03125;
  row.bytes_per_step = 6000;
  row.messages_per_step = 0.5;
  row.latency_us = 1.25;
  row.link_gigabytes_per_second = 8;
  row.joules_per_step = 0.015625;
  row.cycles_per_step = 4096;
  row.instructions_per_step = 8192.5;
  row.cache_misses_per_step = 0.25;
  row.frame_steps = 33;
  row.frame_p50_ms = 33 * ms;
  row.frame_p95_ms = 34 * ms;
  row.frame_p99_ms = 66 * ms;
  row.setup_s = 0.125;
  row.compile_s = 0.0625;
  row.first_step_ms = 4 * ms;
  row.peak_memory_bytes = 3'000'000;
  row.verified = true;
  row.warm_up_trials = 4;
  row.samples_ms = {2 * ms, ms / 2, ms};
  row.sample_steps = {10, 20, 30};
  return row;
}

/// The row with each of its three samples twice: six rounds, the fewest that have a 95 % interval.
inline ResultRow in_six_rounds(ResultRow row) {
  row.rounds = 6;
  for (std::size_t round = 0; round < 3; ++round) {
    row.samples_ms.push_back(row.samples_ms[round]);
    row.sample_steps.push_back(row.sample_steps[round]);
  }
  return row;
}

/// A row that nothing was measured for.
inline ResultRow failed_row(const std::string& backend, const std::string& status) {
  ResultRow row = measured_row(backend, 1, std::nullopt);
  for (const ResultColumn& column : result_columns)
    if (const auto* number = std::get_if<std::optional<double> ResultRow::*>(&column.value))
      (row.**number).reset();
  row.state_hash.reset();
  row.peak_memory_bytes.reset();
  row.frame_steps.reset();
  row.samples_ms.clear();
  row.sample_steps.clear();
  row.rounds = 0;
  row.verified = false;
  row.status = status;
  return row;
}

inline Provenance made_up_provenance() {
  Provenance provenance;
  provenance.build = {"0.1.0", "0123456789abcdef0123456789abcdef01234567", true, "GNU 12", "-O3", "Release"};
  provenance.machine.cpu_model = "A Processor";
  provenance.machine.logical_cpus = 2;
  provenance.machine.cpu_mhz = 2999.6;
  provenance.machine.caches = {{1, "Data", 49152, 2, 1}};
  provenance.machine.load_average = {0.5, 0.25, 0.125};
  provenance.threads = 2;
  provenance.command_line = {"mssim", "bench"};
  provenance.started_utc = "2026-01-31T12:00:00Z";
  return provenance;
}

inline const PaperLegend legend{
    {{"serial", "cpu-only"},
     {"threads-mutex", "multi-thread-cpu", true},
     {"threads-mutex:10", "multi-thread-cpu", true},
     {"threads-mutex:each", "multi-thread-cpu", true},
     {"openmp", "multi-thread-cpu", true},
     {"opencl", "gpu"},
     {"hybrid", "gpu+multi-thread-cpu", true},
     {"hybrid:each", "gpu+multi-thread-cpu", true},
     {"algorithm1", ""},
     {"algorithm1-simd", ""},
     {"algorithm1-threads-simd", "", true}},
    {{"semi-euler", "semi-euler", 1}, {"rk4", "rk4", 4}, {"rk4-frozen", "rk4", 1}}};

/// Rows of two published scenes and of one that is not.
inline std::vector<ResultRow> table_rows() {
  std::vector<ResultRow> rows{measured_row("serial", 0.1, 1.0), measured_row("openmp", 0.0125, 8.0),
                              measured_row("hybrid", 0.05, 2.0),
                              failed_row("opencl", "failed: step 3 | node 7 is not finite")};
  rows[2].device = "Some device";
  rows.push_back(measured_row("serial", 1.5, 1.0));
  rows.back().scene = "cloth350k";
  rows.back().nodes = 350000;
  rows.back().springs_published = 4188004;
  rows.push_back(measured_row("serial", 3, 1.0));
  rows.back().scene = "my-own";
  rows.back().nodes = 2501;
  return rows;
}

/// The one table of a suite that has one.
inline ResultTable only_table(const std::vector<ResultTable>& tables, const std::string& name) {
  EXPECT_EQ(tables.size(), 1U);
  EXPECT_EQ(tables.front().name, name);
  return tables.front();
}

}  // namespace mssim
