#include "output/tables/timings_csv.h"

#include <algorithm>
#include <climits>
#include <functional>
#include <map>
#include <string_view>
#include <tuple>

#include "statistics/outliers.h"
#include "text/fnv1a.h"

namespace mssim {
namespace {

/// A column of timings.csv: its name, and how a row is written to it and read from it.
struct Column {
  std::string_view name;
  std::function<std::string(const ResultRow&)> write;
  std::function<void(ResultRow&, const CsvTable&, std::size_t record, std::size_t column)> read;
};

Column text(std::string_view name, std::string ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return row.*field; },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            row.*field = table.text(r, c);
          }};
}

Column count(std::string_view name, std::uint64_t ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return std::to_string(row.*field); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            row.*field = table.count(r, c);
          }};
}

Column count(std::string_view name, std::optional<std::uint64_t> ResultRow::*field) {
  return {name,
          [=](const ResultRow& row) { return row.*field ? std::to_string(*(row.*field)) : std::string(); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            if (!table.text(r, c).empty()) row.*field = table.count(r, c);
          }};
}

int read_int(const CsvTable& table, std::size_t record, std::size_t column) {
  const std::uint64_t value = table.count(record, column);
  if (value > INT_MAX) throw table.complaint(record, column, "is too large");
  return static_cast<int>(value);
}

Column count(std::string_view name, int ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return std::to_string(row.*field); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            row.*field = read_int(table, r, c);
          }};
}

Column number(std::string_view name, double ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return csv_number(row.*field); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            row.*field = table.number(r, c);
          }};
}

Column number(std::string_view name, std::optional<double> ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return csv_number(row.*field); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            row.*field = table.optional_number(r, c);
          }};
}

Column truth(std::string_view name, bool ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return std::string(row.*field ? "true" : "false"); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            if (table.text(r, c) != "true" && table.text(r, c) != "false")
              throw table.complaint(r, c, "is neither true nor false");
            row.*field = table.text(r, c) == "true";
          }};
}

Column hash(std::string_view name, std::optional<std::uint64_t> ResultRow::*field) {
  return {name, [=](const ResultRow& row) { return row.*field ? hexadecimal(*(row.*field)) : std::string(); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            if (table.text(r, c).empty()) return;
            row.*field = from_hexadecimal(table.text(r, c));
            if (!(row.*field)) throw table.complaint(r, c, "is not a hash of 16 hexadecimal digits");
          }};
}

/// The TABLE of columns, in their order. Readers rely on it: new columns go to the end, and files of older
/// programs, which end after one of `oldest_columns` or more, are read too.
constexpr std::size_t oldest_columns = 24;
const std::vector<Column>& columns() {
  using Row = ResultRow;
  static const std::vector<Column> table{
      text("scene", &Row::scene),
      count("nodes", &Row::nodes),
      count("springs_unique", &Row::springs_unique),
      count("springs_published", &Row::springs_published),
      text("backend", &Row::backend),
      text("device", &Row::device),
      count("threads", &Row::threads),
      text("integrator", &Row::integrator),
      number("dt_s", &Row::dt_s),
      count("rounds", &Row::rounds),
      number("ms_per_step", &Row::ms_per_step),
      number("ms_per_step_low", &Row::ms_per_step_low),
      number("ms_per_step_high", &Row::ms_per_step_high),
      number("ms_per_step_min", &Row::ms_per_step_min),
      number("springs_per_second", &Row::springs_per_second),
      number("gigabytes_per_second", &Row::gigabytes_per_second),
      number("roofline_fraction", &Row::roofline_fraction),
      number("speedup_vs_serial", &Row::speedup_vs_serial),
      number("paper_ms", &Row::paper_ms),
      number("position_error", &Row::position_error),
      number("energy_drift", &Row::energy_drift),
      truth("verified", &Row::verified),
      text("status", &Row::status),
      text("note", &Row::note),
      count("warm_up_trials", &Row::warm_up_trials),
      count("outliers", &Row::outliers),
      hash("state_hash", &Row::state_hash),
  };
  return table;
}

const std::vector<std::string_view> sample_columns{"scene", "backend",     "integrator", "round",
                                                   "steps", "ms_per_step", "outlier"};
constexpr std::size_t oldest_sample_columns = 6;

}  // namespace

std::string timings_csv(std::span<const ResultRow> rows) {
  std::vector<std::string> fields;
  for (const Column& column : columns()) fields.emplace_back(column.name);
  std::string csv = csv_line(fields);
  for (const ResultRow& row : rows) {
    fields.clear();
    for (const Column& column : columns()) fields.push_back(column.write(row));
    csv += csv_line(fields);
  }
  return csv;
}

std::string samples_csv(std::span<const ResultRow> rows) {
  std::string csv = csv_line({sample_columns.begin(), sample_columns.end()});
  for (const ResultRow& row : rows) {
    if (row.samples_ms.empty()) continue;
    const std::vector<Outlier> labels = outliers(row.samples_ms);
    for (std::size_t round = 0; round < row.samples_ms.size(); ++round)
      csv += csv_line({row.scene, row.backend, row.integrator, std::to_string(round + 1),
                       std::to_string(row.sample_steps.at(round)), csv_number(row.samples_ms[round]),
                       std::string(name_of(labels[round]))});
  }
  return csv;
}

std::vector<ResultRow> read_timings(const std::filesystem::path& file) {
  return read_timings(CsvTable(file));
}

std::vector<ResultRow> read_timings(const CsvTable& table) {
  std::vector<std::string_view> names;
  for (const Column& column : columns()) names.push_back(column.name);
  names.resize(std::clamp(table.header().size(), oldest_columns, names.size()));
  table.require_columns(names);
  std::vector<ResultRow> rows(table.size());
  for (std::size_t record = 0; record < rows.size(); ++record)
    for (std::size_t column = 0; column < names.size(); ++column)
      columns()[column].read(rows[record], table, record, column);
  return rows;
}

void read_samples(const std::filesystem::path& file, std::span<ResultRow> rows) {
  read_samples(CsvTable(file), rows);
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
      throw table.complaint(record, 3, "is not the next round of its row; measure anew without --resume");
    row.sample_steps.push_back(read_int(table, record, 4));
    row.samples_ms.push_back(table.number(record, 5));
  }
}

}  // namespace mssim
