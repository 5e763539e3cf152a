#include <climits>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "output/tables/results.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

using nlohmann::ordered_json;

/// "scene/backend/integrator", the usual form of a benchmark's name.
std::string name_of_benchmark(const ResultRow& row) {
  return fmt::format("{}/{}/{}", row.scene, row.backend, row.integrator);
}

Cell cell_of(const ResultRow& row, const ResultColumn& column) {
  if (column.is_hash)
    if (const auto& hash = row.*std::get<std::optional<std::uint64_t> ResultRow::*>(column.value))
      return to_hex(*hash);
  return std::visit([&](auto value) { return Cell(row.*value); }, column.value);
}

/// Place of a value in a file.
struct Place {
  const CsvTable& table;
  std::size_t record, column;
  bool is_hash = false;

  const std::string& text() const { return table.text(record, column); }
  void read(std::string& value) const { value = text(); }
  void read(bool& value) const { value = table.truth(record, column); }
  void read(double& value) const { value = table.number(record, column); }
  void read(int& value) const {
    const std::uint64_t count = table.count(record, column);
    if (count > INT_MAX) throw table.complaint(record, column, "is too large");
    value = static_cast<int>(count);
  }
  void read(std::uint64_t& value) const {
    if (!is_hash) {
      value = table.count(record, column);
    } else if (const auto hash = from_hex(text())) {
      value = *hash;
    } else {
      throw table.complaint(record, column, "is not a hash of 16 hexadecimal digits");
    }
  }
  template <class Value>
  void read(std::optional<Value>& value) const {
    if (!text().empty()) read(value.emplace());
  }
};

/// A column of timings.csv, under its name or another one.
struct RowColumn {
  std::string_view name;
  const ResultColumn* source;

  RowColumn(const ResultColumn& column) : name(column.name), source(&column) {}
  /// Throws std::invalid_argument if there is no such column.
  RowColumn(const char* column) : RowColumn(column, column) {}
  RowColumn(const char* name_, std::string_view column)
      : name(name_), source(found_in(result_columns, column, &ResultColumn::name)) {
    if (source == nullptr) throw std::invalid_argument("timings.csv has no column " + std::string(column));
  }
};

/// The type of a column's values in JSON, and their bounds.
ordered_json type_of(const ResultColumn& column) {
  if (column.is_hash) return {{"type", {"string", "null"}}, {"pattern", "^[0-9a-f]{16}$"}};
  return std::visit(
      []<class Value>(Value ResultRow::*) -> ordered_json {
        if constexpr (std::same_as<Value, std::string>) return {{"type", "string"}};
        if constexpr (std::same_as<Value, bool>) return {{"type", "boolean"}};
        if constexpr (std::same_as<Value, double>) return {{"type", "number"}};
        if constexpr (std::same_as<Value, std::optional<double>>) return {{"type", {"number", "null"}}};
        if constexpr (std::same_as<Value, std::optional<std::uint64_t>>)
          return {{"type", {"integer", "null"}}, {"minimum", 0}};
        return {{"type", "integer"}, {"minimum", 0}};
      },
      column.value);
}

/// The JSON Schema of a table of these columns, which are all of timings.csv.
std::string rows_schema(std::string_view title, std::string_view description,
                        const std::vector<RowColumn>& columns) {
  ordered_json names = ordered_json::array(), properties = ordered_json::object();
  for (const RowColumn& column : columns) {
    const ResultColumn& source = *column.source;
    names.push_back(column.name);
    ordered_json& property = properties[std::string(column.name)];
    property = {
        {"description", fmt::format("{}{}{}", source.meaning, source.unit.empty() ? "" : "; ", source.unit)}};
    property.update(type_of(source));
  }
  return json_text({{"$schema", "http://json-schema.org/draft-07/schema#"},
                    {"title", title},
                    {"description", description},
                    {"type", "array"},
                    {"items",
                     {{"type", "object"},
                      {"additionalProperties", false},
                      {"required", names},
                      {"properties", properties}}}});
}

std::vector<RowColumn> all_columns() { return {result_columns.begin(), result_columns.end()}; }

const std::vector<RowColumn>& printed_columns() {
  static const std::vector<RowColumn> columns{"scene",
                                              "nodes",
                                              "springs_published",
                                              "integrator",
                                              "backend",
                                              "threads",
                                              "ms_per_step",
                                              {"low", "ms_per_step_low"},
                                              {"high", "ms_per_step_high"},
                                              {"speedup", "speedup_vs_serial"},
                                              "paper_ms",
                                              {"roofline", "roofline_fraction"},
                                              "position_error",
                                              "verified",
                                              "status"};
  return columns;
}

/// A line for each row.
Table table_of(RowPointers rows, const std::vector<RowColumn>& columns) {
  Table table;
  for (const RowColumn& column : columns) table.columns.push_back({std::string(column.name)});
  for (const ResultRow* row : rows)
    table.rows.push_back(
        mapped<Cell>(columns, [&](const RowColumn& column) { return cell_of(*row, *column.source); }));
  return table;
}

/// Files of older programs, which end after this number of columns or more, are read too.
constexpr std::size_t oldest_columns = 24;

const std::vector<std::string_view> sample_columns{"scene", "backend",     "integrator", "round",
                                                   "steps", "ms_per_step", "outlier"};
constexpr std::size_t oldest_sample_columns = 6;

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
          // As in Google Benchmark: any governor other than "performance" may change the frequency.
          {"cpu_scaling_enabled", machine.governor.has_value() && *machine.governor != "performance"},
          {"caches", caches},
          {"load_avg", machine.load_average},
          {"library_build_type", provenance.build.build_type == "Debug" ? "debug" : "release"},
          {"json_schema_version", 1},
          {"cpu_time_note", "not measured; equal to real_time"}};
}

/// The first members of every entry of a row.
ordered_json entry_of(const ResultRow& row, std::size_t family, const std::string& suffix,
                      const std::string& run_type) {
  const std::string name = name_of_benchmark(row);
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
  double value;  ///< ns, or a ratio if the unit is "percentage"
};

std::vector<Aggregate> aggregates_of(std::span<const double> samples_ms) {
  const MeanDeviation moments = mean_deviation(samples_ms);
  return {{"mean", "time", moments.mean * ns_per_ms},
          {"median", "time", median(samples_ms) * ns_per_ms},
          {"stddev", "time", moments.deviation * ns_per_ms},
          {"cv", "percentage", moments.deviation / moments.mean}};
}

}  // namespace

Table timings_table(std::span<const ResultRow> rows) { return table_of(pointers_to(rows), all_columns()); }

Table printed_table(RowPointers rows) { return rows.empty() ? Table() : table_of(rows, printed_columns()); }

std::string timings_schema() {
  return rows_schema("Rows of mssim bench",
                     "The columns of timings.csv, as the page of mssim report has them in mssim-data.",
                     all_columns());
}

std::string bench_schema() {
  return rows_schema("Output of mssim bench --format json", "A row for each timed combination.",
                     printed_columns());
}

std::string timings_csv(std::span<const ResultRow> rows) { return table_csv(timings_table(rows)); }

std::string samples_csv(std::span<const ResultRow> rows) {
  Table table;
  for (const std::string_view name : sample_columns) table.columns.push_back({std::string(name)});
  for (const ResultRow& row : rows) {
    if (row.samples_ms.empty()) continue;
    const std::vector<Outlier> labels = outliers(row.samples_ms);
    for (std::size_t round = 0; round < row.samples_ms.size(); ++round)
      table.rows.push_back({row.scene, row.backend, row.integrator, round + 1, row.sample_steps.at(round),
                            row.samples_ms[round], name_of(labels[round])});
  }
  return table_csv(table);
}

std::vector<ResultRow> read_timings(const CsvTable& table) {
  auto names = mapped<std::string_view>(result_columns, &ResultColumn::name);
  names.resize(std::clamp(table.header().size(), oldest_columns, names.size()));
  table.require_columns(names);
  std::vector<ResultRow> rows(table.size());
  for (std::size_t record = 0; record < rows.size(); ++record)
    for (std::size_t i = 0; i < names.size(); ++i) {
      const ResultColumn& column = result_columns[i];
      std::visit(
          [&](auto value) {
            Place{table, record, i, column.is_hash}.read(rows[record].*value);
          },
          column.value);
    }
  return rows;
}

void read_samples(const CsvTable& table, std::span<ResultRow> rows) {
  table.require_columns({sample_columns.begin(), sample_columns.begin() + oldest_sample_columns});
  std::map<std::tuple<std::string_view, std::string_view, std::string_view>, ResultRow*> row_of;
  for (ResultRow& row : rows) row_of.try_emplace({row.scene, row.backend, row.integrator}, &row);
  for (std::size_t record = 0; record < table.size(); ++record) {
    const auto found = row_of.find({table.text(record, 0), table.text(record, 1), table.text(record, 2)});
    if (found == row_of.end()) continue;
    ResultRow& row = *found->second;
    if (table.count(record, 3) != row.samples_ms.size() + 1)
      throw table.complaint(record, 3, "is not the next round of its row; measure again without --resume");
    Place{table, record, 4}.read(row.sample_steps.emplace_back());
    row.samples_ms.push_back(table.number(record, 5));
  }
}

std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::size_t scene = table.column("scene"), backend = table.column("backend"),
                    integrator = table.column("integrator"), ms = table.column("ms_per_step_min"),
                    verified = table.column("verified"), status = table.column("status");
  std::vector<CombinationTime> times;
  for (std::size_t row = 0; row < table.size(); ++row) {
    CombinationTime time{{table.text(row, scene), table.text(row, backend), table.text(row, integrator)},
                         {},
                         table.text(row, status)};
    if (time.status == "ok" && table.text(row, verified) != "true") time.status = "failed: not verified";
    if (time.status == "ok") {
      time.least_ms = table.number(row, ms);
      if (!is_time(*time.least_ms)) throw table.complaint(row, ms, fmt::format("is {}", not_a_time));
    }
    times.push_back(std::move(time));
  }
  return times;
}

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

Table github_table(std::span<const ResultRow> rows) {
  Table table;
  for (const ResultRow& row : rows) {
    if (row.status != "ok" || !row.ms_per_step) continue;
    table.add({{"name", name_of_benchmark(row)},
               {"unit", "ms/step"},
               {"value", *row.ms_per_step},
               {"range", has_interval(row) ? fmt::format("{} to {}", csv_number(*row.ms_per_step_low),
                                                         csv_number(*row.ms_per_step_high))
                                           : ""},
               {"extra", row.device + ", " + pluralize(row.threads, "thread")}});
  }
  return table;
}

}  // namespace mssim
