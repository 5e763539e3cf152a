#include "output/folders/result_folder.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "garment/output/garment_csv.h"
#include "output/folders/provenance_file.h"
#include "output/tables/benchmark_json.h"
#include "output/tables/github_table.h"
#include "output/tables/markdown.h"
#include "output/tables/table_csv.h"
#include "output/tables/table_json.h"
#include "output/tables/timings_csv.h"
#include "platform/atomic_file.h"
#include "platform/write_error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr const char* benchmark_name = "benchmark.json";
constexpr const char* github_name = "github.json";

std::string csv_of(std::string_view table) { return std::string(table) + ".csv"; }
std::string markdown_of(std::string_view table) { return std::string(table) + ".md"; }

std::vector<ResultFolder::File> files_of(const ResultTable& table) {
  std::vector<ResultFolder::File> files{{csv_of(table.name), table_csv(table.data)}};
  if (!table.page.empty()) files.push_back({markdown_of(table.name), markdown(table.page)});
  return files;
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder, Provenance provenance, TableMaker tables)
    : folder_(std::move(folder)),
      lock_(make_folder(folder_)),
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
  std::error_code error;
  fs::remove_all(folder_ / programs_name, error);
  if (error) throw WriteError(write_failure(folder_ / programs_name, "removing it", error.value()));
}

void ResultFolder::go_on_with(const Provenance& earlier) {
  provenance_.earlier_starts_utc = earlier.earlier_starts_utc;
  provenance_.earlier_starts_utc.push_back(earlier.started_utc);
}

void ResultFolder::begin() const {
  write_file_atomically(folder_ / "provenance.json", provenance_text(provenance_) + '\n');
}

void ResultFolder::write(std::span<const ResultRow> rows) const {
  std::vector<File> files{{samples_name, samples_csv(rows)}};
  if (std::string garment = garment_csv(rows); !garment.empty())
    files.push_back({garment_name, std::move(garment)});
  files.push_back({benchmark_name, benchmark_json(rows, provenance_)});
  for (const ResultTable& table : tables_(rows, provenance_)) {
    if (std::ranges::find(table_names, table.name) == table_names.end())
      throw std::invalid_argument("the table " + table.name + " is not in table_names");
    std::ranges::move(files_of(table), std::back_inserter(files));
  }
  for (const ResultRow& row : rows) {
    if (row.program_output.empty()) continue;
    make_folder(folder_ / programs_name);
    const std::string name = row.scene + '-' + row.backend + '-' + row.integrator + ".txt";
    files.push_back({(fs::path(programs_name) / name).string(), row.program_output});
  }
  files.push_back({timings_name, timings_csv(rows)});
  write_files(files);
}

void ResultFolder::write_for_github(std::span<const ResultRow> rows) const {
  write_file_atomically(folder_ / github_name, table_json_text(github_table(rows)));
}

void ResultFolder::write(std::span<const ResultTable> tables) const {
  for (const ResultTable& table : tables) write_files(files_of(table));
}

void ResultFolder::write(std::span<const StructureRow> rows) const {
  write_files(files_of(structure_table(rows, provenance_)));
}

void ResultFolder::write_files(const std::vector<File>& files) const {
  for (const File& file : files) write_file_atomically(folder_ / file.name, file.text);
}

std::vector<ResultRow> read_results(const fs::path& folder) {
  if (!fs::exists(folder / timings_name)) return {};
  std::vector<ResultRow> rows = read_timings(folder / timings_name);
  read_samples(folder / samples_name, rows);
  if (fs::exists(folder / garment_name)) read_dressings(folder / garment_name, rows);
  return rows;
}

}  // namespace mssim
