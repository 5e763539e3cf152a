// Results that the page of `mssim web` saved or sent, which `report`, `compare` and `web --serve` read.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "fuzz_checks.h"
#include "output/folders/provenance_file.h"
#include "output/tables/results.h"
#include "text/error.h"
#include "web/web.h"

namespace mssim {
namespace {

/// The file as the page writes it.
std::string text_of(const MeasuredRun& run) {
  const nlohmann::json document{{"mssim_web_results", 1},
                                {"provenance", nlohmann::json::parse(provenance_text(run.provenance))},
                                {"timings_csv", timings_csv(run.rows)},
                                {"samples_csv", samples_csv(run.rows)}};
  return document.dump();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto found =
      unless_refused<Error>([&] { return parse_web_results("fuzz.json", std::string(text_of(data, size))); });
  if (!found) return 0;
  for (const ResultRow& row : found->rows) {
    require(std::ranges::find(browser_backends, row.backend, &BrowserBackend::name) != browser_backends.end(),
            "a page measures the backend");
    require(!counts(row) || !row.samples_ms.empty(), "a row that counts has samples");
    require(counts(row) == row.ms_per_step.has_value(), "a row has a time if it counts");
  }
  const std::string written = text_of(*found);
  require(text_of(parse_web_results("again.json", written)) == written, "written results read back");
  return 0;
}

}  // namespace mssim
