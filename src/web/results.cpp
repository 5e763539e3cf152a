#include "output/tables/results.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrators/all_integrators.h"
#include "output/folders/provenance_file.h"
#include "output/folders/result_folder.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"
#include "web/web.h"

namespace mssim {
namespace {

using nlohmann::json;

constexpr std::size_t largest_results_bytes = std::size_t{64} << 20;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem) {
  throw UsageError("{}: {}; give a file that the page of mssim web saved", printable(file.string()), problem);
}

bool are_close(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || std::abs(*a - *b) <= 1e-9 * std::abs(*b));
}

/// The row with all that follows from its samples. The page computes its times by the same formulas as mssim:
/// others are made up.
ResultRow checked(const std::filesystem::path& file, const ResultRow& row, const ResultRow* baseline) {
  const auto require = [&](bool good, const std::string& what) {
    if (!good) refuse(file, combination_name(row) + ": " + what);
  };
  const Integrator* integrator = find_integrator(row.integrator);
  require(integrator != nullptr && !is_implicit(*integrator), "there is no such explicit integrator");
  require(is_browser_backend(row.backend), "no page measures such a backend");
  require(row.nodes > 0 && row.springs_unique > 0 && row.dt_s > 0, "it has no nodes, springs or step");
  require(!row.verified || row.position_error, "it is verified without an error");
  if (const auto bad = std::ranges::find_if_not(row.samples_ms, is_time); bad != row.samples_ms.end())
    require(false,
            fmt::format("round {} is {:.6g} ms, {}", bad - row.samples_ms.begin() + 1, *bad, not_a_time));
  ResultRow again = row;
  again.ms_per_step = again.ms_per_step_low = again.ms_per_step_high = again.ms_per_step_min = {};
  summarise(again, baseline != nullptr && counts(*baseline) ? baseline : nullptr);
  require(counts(row) == again.ms_per_step.has_value() && row.rounds == again.rounds &&
              are_close(row.ms_per_step, again.ms_per_step) &&
              are_close(row.ms_per_step_low, again.ms_per_step_low) &&
              are_close(row.ms_per_step_high, again.ms_per_step_high) &&
              are_close(row.ms_per_step_min, again.ms_per_step_min),
          "its times do not follow from its samples");
  return again;
}

}  // namespace

bool is_web_results(const std::filesystem::path& path) {
  std::error_code error;
  return path.extension() == ".json" && std::filesystem::is_regular_file(path, error) &&
         path.filename() != provenance_name && path.filename() != benchmark_name &&
         path.filename() != github_name;
}

MeasuredRun read_web_results(const std::filesystem::path& file) {
  return parse_web_results(
      file,
      read_file_or<UsageError>(file, "give a file that the page of mssim web saved", largest_results_bytes));
}

MeasuredRun parse_web_results(const std::filesystem::path& file, const std::string& text) {
  // Printing a value recurses, and a provenance has four levels.
  constexpr int deepest_level = 32;
  const auto is_flat = [](int depth, json::parse_event_t /*event*/, const json& /*parsed*/) {
    return depth <= deepest_level;
  };
  const json document = json::parse(text, is_flat, false);
  if (!document.is_object() || !document.contains("mssim_web_results") || document["mssim_web_results"] != 1)
    refuse(file, "it is damaged or no result of a page");
  const auto text_of = [&](const char* name) {
    if (!document.contains(name) || !document[name].is_string())
      refuse(file, fmt::format("it has no {}", name));
    return document[name].get<std::string>();
  };
  if (!document.contains("provenance")) refuse(file, "it has no provenance");
  MeasuredRun run{parse_provenance(file, document["provenance"].dump()), {}};
  run.rows = read_timings(CsvTable(file.string() + ", timings_csv", text_of("timings_csv")));
  read_samples(CsvTable(file.string() + ", samples_csv", text_of("samples_csv")), run.rows);
  const std::vector<const ResultRow*> rows = pointers_to(run.rows);
  std::vector<ResultRow> all;
  for (const ResultRow& row : run.rows) all.push_back(checked(file, row, baseline_of(rows, row)));
  run.rows = std::move(all);
  return run;
}

}  // namespace mssim
