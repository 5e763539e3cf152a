#include "output/tables/benchmark_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "output/tables/table.h"
#include "statistics/statistics.h"

namespace mssim {
namespace {

using nlohmann::ordered_json;

constexpr double ns_per_ms = 1e6;

ordered_json context_of(const Provenance& provenance) {
  const Machine& machine = provenance.machine;
  ordered_json caches = ordered_json::array();
  for (const Cache& cache : machine.caches)
    caches.push_back({{"type", cache.type},
                      {"level", cache.level},
                      {"size", cache.bytes},
                      {"num_sharing", cache.sharing}});
  std::string date = provenance.started_utc;
  if (date.ends_with('Z')) date.replace(date.size() - 1, 1, "+00:00");  // the form Google Benchmark writes
  return {{"date", date},
          {"host_name", ""},
          {"executable", provenance.command_line.empty() ? "" : provenance.command_line.front()},
          {"num_cpus", machine.logical_cpus},
          {"mhz_per_cpu", std::lround(machine.cpu_mhz)},
          // As Google Benchmark has it: any governor but "performance" may change the frequency.
          {"cpu_scaling_enabled", machine.governor.has_value() && *machine.governor != "performance"},
          {"caches", caches},
          {"load_avg", machine.load_average},
          {"library_build_type", provenance.build.build_type == "Debug" ? "debug" : "release"},
          {"json_schema_version", 1},
          {"cpu_time_note", "not measured; equal to real_time"}};
}

/// What every entry of a row begins with.
ordered_json entry_of(const ResultRow& row, std::size_t family, const std::string& suffix,
                      const std::string& run_type) {
  const std::string name = row.scene + '/' + row.backend + '/' + row.integrator;
  return {{"name", name + suffix}, {"family_index", family}, {"per_family_instance_index", 0},
          {"run_name", name},      {"run_type", run_type},   {"repetitions", row.samples_ms.size()}};
}

/// In nanoseconds, because compare.py prints times without decimals.
void add_time(ordered_json& entry, double time_ns) {
  if (!std::isfinite(time_ns)) throw std::invalid_argument("benchmark.json: a time is not finite");
  entry["real_time"] = time_ns;
  entry["cpu_time"] = time_ns;
  entry["time_unit"] = "ns";
}

struct Aggregate {
  std::string name, unit;
  double value;  ///< ns, or a ratio where the unit is "percentage"
};

std::vector<Aggregate> aggregates_of(std::span<const double> samples_ms) {
  const MeanDeviation moments = mean_deviation(samples_ms);
  return {{"mean", "time", moments.mean * ns_per_ms},
          {"median", "time", median(samples_ms) * ns_per_ms},
          {"stddev", "time", moments.deviation * ns_per_ms},
          {"cv", "percentage", moments.deviation / moments.mean}};
}

}  // namespace

std::string benchmark_json(std::span<const ResultRow> rows, const Provenance& provenance) {
  ordered_json benchmarks = ordered_json::array();
  std::size_t family = 0;
  for (const ResultRow& row : rows) {
    if (row.status != "ok") continue;
    for (std::size_t sample = 0; sample < row.samples_ms.size(); ++sample) {
      ordered_json entry = entry_of(row, family, "", "iteration");
      entry["repetition_index"] = sample;
      entry["threads"] = row.threads;
      entry["iterations"] = row.sample_steps.at(sample);
      add_time(entry, row.samples_ms[sample] * ns_per_ms);
      benchmarks.push_back(std::move(entry));
    }
    if (row.samples_ms.size() >= 2) {
      for (const Aggregate& aggregate : aggregates_of(row.samples_ms)) {
        ordered_json entry = entry_of(row, family, '_' + aggregate.name, "aggregate");
        entry["threads"] = row.threads;
        entry["aggregate_name"] = aggregate.name;
        entry["aggregate_unit"] = aggregate.unit;
        entry["iterations"] = row.samples_ms.size();
        add_time(entry, aggregate.value);
        benchmarks.push_back(std::move(entry));
      }
    }
    ++family;
  }
  return json_text({{"context", context_of(provenance)}, {"benchmarks", std::move(benchmarks)}});
}

}  // namespace mssim
