#include "web/web.h"

#include <nlohmann/json.hpp>
#include <span>

#include "output/folders/provenance_file.h"
#include "output/tables/results.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

using nlohmann::json;

ResultRow row_of(const std::string& backend, std::vector<double> samples_ms) {
  ResultRow row;
  row.scene = "cloth2500";
  row.nodes = 2500;
  row.springs_unique = 14502;
  row.backend = backend;
  row.device = backend == "webgpu" ? "a phone's GPU" : "cpu";
  row.threads = 1;
  row.integrator = "semi-euler";
  row.dt_s = 5e-5;
  row.verified = true;
  row.position_error = 1e-6;
  row.samples_ms = std::move(samples_ms);
  row.sample_steps.assign(row.samples_ms.size(), 10);
  row.rounds = static_cast<int>(row.samples_ms.size());
  return row;
}

/// Two rows of three rounds, with times as the page writes them.
std::vector<ResultRow> rows_of_a_page() {
  std::vector<ResultRow> rows{row_of("javascript", {4, 6, 5}), row_of("webgpu", {2, 1, 1.25})};
  rows[0].ms_per_step = 5;
  rows[0].ms_per_step_low = rows[0].ms_per_step_min = 4;
  rows[0].ms_per_step_high = 6;
  rows[1].ms_per_step = 1.25;
  rows[1].ms_per_step_low = rows[1].ms_per_step_min = 1;
  rows[1].ms_per_step_high = 2;
  return rows;
}

json document_of(std::span<const ResultRow> rows) {
  return {{"mssim_web_results", 1},
          {"provenance", json::parse(provenance_text(Provenance()))},
          {"timings_csv", timings_csv(rows)},
          {"samples_csv", samples_csv(rows)}};
}

TEST(WebResults, HaveWhatFollowsFromTheirSamples) {
  const MeasuredRun run = parse_web_results("page.json", document_of(rows_of_a_page()).dump());
  ASSERT_EQ(run.rows.size(), 2U);
  // The median of 4/2, 6/1 and 5/1.25.
  EXPECT_DOUBLE_EQ(run.rows[1].speedup_vs_serial.value(), 4);
  EXPECT_DOUBLE_EQ(run.rows[1].springs_per_second.value(), 14502 / 1.25e-3);
}

TEST(WebResults, HaveRowsOfEachBackendOfThePage) {
  std::vector<ResultRow> rows;
  for (const BrowserBackend& backend : browser_backends) {
    rows.push_back(row_of(std::string(backend.name), {2, 2, 2}));
    rows.back().ms_per_step = rows.back().ms_per_step_low = rows.back().ms_per_step_high =
        rows.back().ms_per_step_min = 2;
  }
  const MeasuredRun run = parse_web_results("page.json", document_of(rows).dump());
  ASSERT_EQ(run.rows.size(), 4U);
  for (const char* backend : {"wasm", "wasm-threads", "webgpu"}) {
    const auto row = std::ranges::find(run.rows, backend, &ResultRow::backend);
    ASSERT_NE(row, run.rows.end()) << backend;
    EXPECT_DOUBLE_EQ(row->speedup_vs_serial.value(), 1) << backend;
  }
}

TEST(WebResults, AreRefusedIfMadeUp) {
  const auto expect_refused = [](const std::string& what, const auto& change) {
    std::vector<ResultRow> rows = rows_of_a_page();
    change(rows[1]);
    EXPECT_THAT(sentence_of<UsageError>([&] { parse_web_results("page.json", document_of(rows).dump()); }),
                AllOf(HasSubstr("page.json"), HasSubstr("cloth2500")))
        << what;
  };
  expect_refused("another median", [](ResultRow& row) { row.ms_per_step = 0.5; });
  expect_refused("another interval", [](ResultRow& row) { row.ms_per_step_high = 1.5; });
  expect_refused("a sample of no time", [](ResultRow& row) { row.samples_ms[1] = 0; });
  expect_refused("samples that are too small for a rate", [](ResultRow& row) {
    row.samples_ms = {1e-310, 1e-310, 1e-310};
    row.ms_per_step = row.ms_per_step_low = row.ms_per_step_high = row.ms_per_step_min = 1e-310;
  });
  expect_refused("a time without samples", [](ResultRow& row) { row.samples_ms.clear(); });
  expect_refused("another backend", [](ResultRow& row) { row.backend = "vulkan"; });
  expect_refused("a backend by half of its name", [](ResultRow& row) { row.backend = "was"; });
  expect_refused("an implicit integrator", [](ResultRow& row) { row.integrator = "xpbd"; });
  expect_refused("verified without an error", [](ResultRow& row) { row.position_error.reset(); });
}

TEST(WebResults, AreRefusedInPrintableText) {
  std::vector<ResultRow> rows = rows_of_a_page();
  rows[1].scene = "cl\x7fth\n4900";
  rows[1].ms_per_step = 0.5;
  EXPECT_THAT(sentence_of<UsageError>([&] { parse_web_results("page.json", document_of(rows).dump()); }),
              HasSubstr("cl\\u007fth\\n4900, "));
}

TEST(WebResults, AreRefusedIfDamaged) {
  const json document = document_of(rows_of_a_page());
  const std::string text = document.dump();
  EXPECT_THROW(parse_web_results("page.json", text.substr(0, text.size() / 2)), UsageError);
  EXPECT_THROW(parse_web_results("page.json", std::string(100'000, '[')), UsageError);
  for (const auto& [name, value] : document.items()) {
    json without = document;
    without.erase(name);
    EXPECT_THROW(parse_web_results("page.json", without.dump()), UsageError) << name;
  }
}

/// The page's data, which stand in one line.
json data_of(const std::string& page) {
  const std::string_view before = "const data =\n";
  const std::size_t begin = page.find(before) + before.size();
  return json::parse(page.substr(begin, page.find(";\n", begin) - begin));
}

TEST(WebPage, HasTheScenesWithAllTheirSprings) {
  const json data = data_of(web_page());
  ASSERT_EQ(data["scenes"].size(), 12U);
  for (const json& scene : data["scenes"]) {
    if (!scene.contains("bodies")) continue;
    std::size_t nodes = 0, springs = 0;
    for (const json& body : scene["bodies"]) {
      const json& shape = data["shapes"][body[0].get<std::size_t>()];
      nodes += shape["nodes"].get<std::size_t>();
      const std::string rest = shape["rest_lengths"].get<std::string>();  // 4 bytes are 16/3 digits
      springs += (rest.size() / 4 * 3 - static_cast<std::size_t>(std::ranges::count(rest, '='))) / 4;
    }
    EXPECT_EQ(nodes, scene["nodes"].get<std::size_t>());
    EXPECT_EQ(springs, scene["springs_unique"].get<std::size_t>());
  }
  EXPECT_EQ(data["integrators"].size(), 7U);
  EXPECT_EQ(data["integrators"][6]["ahead"], 0.5);
}

}  // namespace
}  // namespace mssim
