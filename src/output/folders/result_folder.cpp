#include "output/folders/result_folder.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "garment/output/garment_csv.h"
#include "output/folders/provenance_file.h"
#include "output/tables/benchmark_json.h"
#include "output/tables/github_json.h"
#include "output/tables/timings_csv.h"
#include "platform/atomic_file.h"
#include "platform/write_error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr const char* timings_name = "timings.csv";
constexpr const char* samples_name = "samples.csv";
constexpr const char* garment_name = "garment.csv";
constexpr const char* benchmark_name = "benchmark.json";
constexpr const char* github_name = "github.json";

std::string csv_of(std::string_view table) { return std::string(table) + ".csv"; }
std::string markdown_of(std::string_view table) { return std::string(table) + ".md"; }

/// The folder, which is there afterwards.
const fs::path& made(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw WriteError(write_failure(folder, "creating the folder", error.value()));
  return folder;
}

/// Bytes that are no UTF-8 (a folder's name may hold any) are replaced.
template <class Json>
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder, Provenance provenance, TableMaker tables)
    : folder_(std::move(folder)),
      lock_(made(folder_)),
      provenance_(std::move(provenance)),
      tables_(std::move(tables)) {}

bool ResultFolder::has_rows() const { return fs::exists(folder_ / timings_name); }

bool ResultFolder::has_results() const {
  return has_rows() || std::ranges::any_of(table_names, [&](std::string_view name) {
           return fs::exists(folder_ / csv_of(name));
         });
}

void ResultFolder::clear() const {
  std::vector<std::string> names{timings_name, samples_name, garment_name, benchmark_name, github_name};
  for (const std::string_view table : table_names) {
    names.push_back(csv_of(table));
    names.push_back(markdown_of(table));
  }
  for (const std::string& name : names) {
    std::error_code error;
    fs::remove(folder_ / name, error);
    if (error) throw WriteError(write_failure(folder_ / name, "removing it", error.value()));
  }
}

void ResultFolder::go_on_with(const Provenance& earlier) {
  provenance_.earlier_starts_utc = earlier.earlier_starts_utc;
  provenance_.earlier_starts_utc.push_back(earlier.started_utc);
}

void ResultFolder::begin() const {
  write_file_atomically(folder_ / "provenance.json", provenance_text(provenance_) + '\n');
}

void ResultFolder::write(std::span<const ResultRow> rows) const {
  const std::string timings = timings_csv(rows), samples = samples_csv(rows), garment = garment_csv(rows);
  const std::string benchmark = text_of(benchmark_json(rows, provenance_));
  const std::vector<ResultTable> tables = tables_(rows, provenance_);
  for (const ResultTable& table : tables)
    if (std::ranges::find(table_names, table.name) == table_names.end())
      throw std::invalid_argument("the table " + table.name + " is not in table_names");
  write_file_atomically(folder_ / samples_name, samples);
  if (!garment.empty()) write_file_atomically(folder_ / garment_name, garment);
  write_file_atomically(folder_ / benchmark_name, benchmark);
  for (const ResultTable& table : tables) {
    write_file_atomically(folder_ / csv_of(table.name), table.csv);
    write_file_atomically(folder_ / markdown_of(table.name), table.markdown);
  }
  write_file_atomically(folder_ / timings_name, timings);
}

void ResultFolder::write_for_github(std::span<const ResultRow> rows) const {
  write_file_atomically(folder_ / github_name, text_of(github_json(rows)));
}

void ResultFolder::write(std::span<const StructureRow> rows) const {
  const StructureTable table = structure_table(rows, provenance_);
  write_file_atomically(folder_ / csv_of("table2"), table.csv);
  write_file_atomically(folder_ / markdown_of("table2"), table.markdown);
}

std::vector<ResultRow> read_results(const fs::path& folder) {
  if (!fs::exists(folder / timings_name)) return {};
  std::vector<ResultRow> rows = read_timings(folder / timings_name);
  read_samples(folder / samples_name, rows);
  if (fs::exists(folder / garment_name)) read_dressings(folder / garment_name, rows);
  return rows;
}

}  // namespace mssim
