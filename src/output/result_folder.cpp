#include "output/result_folder.h"

#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "output/atomic_file.h"
#include "output/benchmark_json.h"
#include "output/timings_csv.h"
#include "output/write_error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr const char* timings_name = "timings.csv";
constexpr const char* samples_name = "samples.csv";

/// Bytes that are no UTF-8 (a folder's name may hold any) are replaced.
template <class Json>
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder, Provenance provenance, PaperLegend legend,
                           PublishedTable published)
    : folder_(std::move(folder)),
      provenance_(std::move(provenance)),
      legend_(std::move(legend)),
      published_(std::move(published)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw WriteError(write_failure(folder_, "creating the folder", error.value()));
  write_file_atomically(folder_ / "provenance.json", text_of(to_json(provenance_)));
}

void ResultFolder::write(std::span<const ResultRow> rows) const {
  const std::string timings = timings_csv(rows), samples = samples_csv(rows);
  const std::string benchmark = text_of(benchmark_json(rows, provenance_));
  const PaperTable table1 = paper_table1(rows, legend_, published_, provenance_);
  write_file_atomically(folder_ / samples_name, samples);
  write_file_atomically(folder_ / "benchmark.json", benchmark);
  if (!table1.empty) {
    write_file_atomically(folder_ / "table1.csv", table1.csv);
    write_file_atomically(folder_ / "table1.md", table1.markdown);
  }
  write_file_atomically(folder_ / timings_name, timings);
}

std::vector<ResultRow> read_results(const fs::path& folder) {
  if (!fs::exists(folder / timings_name)) return {};
  std::vector<ResultRow> rows = read_timings(folder / timings_name);
  read_samples(folder / samples_name, rows);
  return rows;
}

}  // namespace mssim
