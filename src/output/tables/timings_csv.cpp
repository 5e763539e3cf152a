#include "output/tables/timings_csv.h"

#include <algorithm>
#include <climits>
#include <functional>
#include <map>
#include <string_view>
#include <tuple>

#include "output/tables/table.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A column of timings.csv: its name, and how a row is written to it and read from it.
struct TimingsColumn {
  std::string_view name;
  std::function<Cell(const ResultRow&)> write;
  std::function<void(ResultRow&, const CsvTable&, std::size_t record, std::size_t column)> read;
};

void read(const CsvTable& table, std::size_t record, std::size_t column, std::string& value) {
  value = table.text(record, column);
}
void read(const CsvTable& table, std::size_t record, std::size_t column, std::uint64_t& value) {
  value = table.count(record, column);
}
void read(const CsvTable& table, std::size_t record, std::size_t column, int& value) {
  const std::uint64_t count = table.count(record, column);
  if (count > INT_MAX) throw table.complaint(record, column, "is too large");
  value = static_cast<int>(count);
}
void read(const CsvTable& table, std::size_t record, std::size_t column, double& value) {
  value = table.number(record, column);
}
void read(const CsvTable& table, std::size_t record, std::size_t column, bool& value) {
  value = table.truth(record, column);
}
template <class Value>
void read(const CsvTable& table, std::size_t record, std::size_t column, std::optional<Value>& value) {
  if (!table.text(record, column).empty()) read(table, record, column, value.emplace());
}

template <class Value>
TimingsColumn field(std::string_view name, Value ResultRow::*value) {
  return {name, [=](const ResultRow& row) { return Cell(row.*value); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            read(table, r, c, row.*value);
          }};
}

TimingsColumn hash(std::string_view name, std::optional<std::uint64_t> ResultRow::*value) {
  return {name, [=](const ResultRow& row) { return row.*value ? Cell(to_hex(*(row.*value))) : Cell(); },
          [=](ResultRow& row, const CsvTable& table, std::size_t r, std::size_t c) {
            if (table.text(r, c).empty()) return;
            row.*value = from_hex(table.text(r, c));
            if (!(row.*value)) throw table.complaint(r, c, "is not a hash of 16 hexadecimal digits");
          }};
}

/// The TABLE of columns, in their order. Readers rely on it: new columns go to the end, and files of older
/// programs, which end after one of `oldest_columns` or more, are read too.
constexpr std::size_t oldest_columns = 24;
const std::vector<TimingsColumn>& columns() {
  using Row = ResultRow;
  static const std::vector<TimingsColumn> table{
      field("scene", &Row::scene),
      field("nodes", &Row::nodes),
      field("springs_unique", &Row::springs_unique),
      field("springs_published", &Row::springs_published),
      field("backend", &Row::backend),
      field("device", &Row::device),
      field("threads", &Row::threads),
      field("integrator", &Row::integrator),
      field("dt_s", &Row::dt_s),
      field("rounds", &Row::rounds),
      field("ms_per_step", &Row::ms_per_step),
      field("ms_per_step_low", &Row::ms_per_step_low),
      field("ms_per_step_high", &Row::ms_per_step_high),
      field("ms_per_step_min", &Row::ms_per_step_min),
      field("springs_per_second", &Row::springs_per_second),
      field("gigabytes_per_second", &Row::gigabytes_per_second),
      field("roofline_fraction", &Row::roofline_fraction),
      field("speedup_vs_serial", &Row::speedup_vs_serial),
      field("paper_ms", &Row::paper_ms),
      field("position_error", &Row::position_error),
      field("energy_drift", &Row::energy_drift),
      field("verified", &Row::verified),
      field("status", &Row::status),
      field("note", &Row::note),
      field("warm_up_trials", &Row::warm_up_trials),
      field("outliers", &Row::outliers),
      hash("state_hash", &Row::state_hash),
      field("processors_used", &Row::processors_used),
      field("waiting_share", &Row::waiting_share),
      field("packing_share", &Row::packing_share),
      field("bytes_per_step", &Row::bytes_per_step),
      field("messages_per_step", &Row::messages_per_step),
      field("latency_us", &Row::latency_us),
      field("link_gigabytes_per_second", &Row::link_gigabytes_per_second),
  };
  return table;
}

const std::vector<std::string_view> sample_columns{"scene", "backend",     "integrator", "round",
                                                   "steps", "ms_per_step", "outlier"};
constexpr std::size_t oldest_sample_columns = 6;

}  // namespace

Table timings_table(std::span<const ResultRow> rows) {
  Table table;
  for (const TimingsColumn& column : columns()) table.columns.push_back({std::string(column.name)});
  for (const ResultRow& row : rows) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    for (const TimingsColumn& column : columns()) cells.push_back(column.write(row));
  }
  return table;
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

std::vector<ResultRow> read_timings(const std::filesystem::path& file) {
  return read_timings(CsvTable(file));
}

std::vector<ResultRow> read_timings(const CsvTable& table) {
  std::vector<std::string_view> names;
  for (const TimingsColumn& column : columns()) names.push_back(column.name);
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
    read(table, record, 4, row.sample_steps.emplace_back());
    row.samples_ms.push_back(table.number(record, 5));
  }
}

}  // namespace mssim
