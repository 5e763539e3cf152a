#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

ResultTable paper_table_of(const std::vector<ResultRow>& rows,
                           const Provenance& provenance = made_up_provenance()) {
  return only_table(paper_tables(legend, {PublishedTable(published_table_kinds[0])})(rows, provenance),
                    "table1");
}

std::string csv_of(const std::vector<ResultRow>& rows) { return table_csv(paper_table_of(rows).data); }

std::string page_of(const std::vector<ResultRow>& rows, const Provenance& provenance = made_up_provenance()) {
  return markdown(paper_table_of(rows, provenance).page);
}

TEST(Published, TimesExistOnlyForWhatThePaperMeasured) {
  const PublishedTable table = PublishedTable(published_table_kinds[0]);
  EXPECT_EQ(table.ms("rk4", "gpu+multi-thread-cpu", 2500, 29004), std::nullopt);
  EXPECT_EQ(table.ms("rk4-frozen", "gpu", 2500, 29004), std::nullopt);
  EXPECT_EQ(table.ms("rk4", "gpu", 2501, 29004), std::nullopt);
  EXPECT_EQ(table.ms("rk4", "gpu", 2500, 29000), std::nullopt);  // 2500 nodes, but another shape
  EXPECT_TRUE(table.has_scene(350000, 4188004));
  EXPECT_FALSE(table.has_scene(2500, 29000));
}

TEST(Published, TableOfBodiesReadsToo) {
  const PublishedTable table(published_table_kinds[1]);
  EXPECT_EQ(table.ms("semi-euler", "gpu+multi-thread-cpu", 38233, 759330), 127.45);
}

TEST(PaperTable, AsCsvHasPublishedAndMeasuredUnderOneAnother) {
  const std::string csv = csv_of(table_rows());
  EXPECT_THAT(csv, StartsWith("integrator,configuration,backend,quantity,cloth2500,cloth350k\n"
                              ",,,nodes,2500,350000\n"
                              ",,,springs_published,29004,4188004\n"
                              "semi-euler,cpu-only,serial,published_ms,19.475,2733.484\n"
                              "semi-euler,cpu-only,serial,measured_ms,0.1,1.5\n"));
  EXPECT_THAT(csv, HasSubstr("multi-thread-cpu,openmp,published_speedup," + csv_number(19.475 / 6.6) + "," +
                             csv_number(2733.484 / 586.35) +
                             "\n"
                             "semi-euler,multi-thread-cpu,openmp,measured_speedup,8,\n"
                             "semi-euler,multi-thread-cpu,openmp,status,ok,\n"));
  EXPECT_THAT(csv, HasSubstr("gpu,opencl,measured_ms,,\n"));
  EXPECT_THAT(csv, HasSubstr("gpu,opencl,status,failed: step 3 | node 7 is not finite,\n"));
  EXPECT_THAT(csv,
              HasSubstr("hybrid,published_ms,,\nsemi-euler,gpu+multi-thread-cpu,hybrid,measured_ms,0.05,"));
}

TEST(PaperTable, LeavesOutAnotherSceneOfTheSameSize) {
  std::vector<ResultRow> rows = table_rows();
  for (ResultRow& row : rows) row.scene_as_shipped = row.scene != "cloth2500";
  EXPECT_THAT(csv_of(rows), StartsWith("integrator,configuration,backend,quantity,cloth350k\n"));
  for (ResultRow& row : rows) row.scene_as_shipped = false;
  EXPECT_TRUE(
      paper_tables(legend, {PublishedTable(published_table_kinds[0])})(rows, made_up_provenance()).empty());
}

TEST(PaperTable, AsMarkdownTellsPublishedFromMeasured) {
  const std::string text = page_of(table_rows());
  EXPECT_THAT(text,
              HasSubstr("Measured on A Processor (2 logical CPUs) with 2 threads; device Some device; mssim "
                        "0.1.0, commit 0123456789ab with uncommitted changes; 2026-01-31T12:00:00Z."));
  EXPECT_THAT(text,
              HasSubstr("## semi-euler: 1 force evaluation per step, compared with the published semi-euler\n"
                        "\n"
                        "| nodes<br>springs | 2,500<br>29,004 | 350,000<br>4,188,004 |\n"
                        "|---|---:|---:|\n"
                        "| CPU only, *published* | 19.475 | 2733.484 |\n"
                        "| `serial`, **measured** | **0.100** | **1.50** |\n"
                        "| Multi-thread CPU, *published* | 6.6 (2.95×) | 586.35 (4.66×) |\n"
                        "| `openmp`, **measured** | **0.0125** (8.00×) | – |\n"
                        "| GPU, *published* | 1.827 (10.7×) | 115.015 (23.8×) |\n"
                        "| `opencl`, **measured** | failed | – |\n"
                        "| GPU + multi-thread CPU, *not published* | – | – |\n"
                        "| `hybrid` on Some device, **measured** | **0.0500** (2.00×) | – |\n"));
  EXPECT_THAT(text,
              HasSubstr("- `opencl`, `semi-euler`: failed: step 3 \\| node 7 is not finite (`cloth2500`)\n"));
  EXPECT_THAT(text, HasSubstr("`rk4-frozen` (`--integrator all`), which the paper does not have"));
  EXPECT_THAT(text, Not(HasSubstr("my-own")));
}

TEST(PaperTable, HasVariantsBelowOnePublishedLine) {
  std::vector<ResultRow> rows = table_rows();
  EXPECT_THAT(page_of(rows), Not(HasSubstr(":each")));
  rows.push_back(measured_row("threads-mutex", 0.2, 0.5));
  rows.push_back(measured_row("threads-mutex:10", 0.25, 0.4));
  rows.push_back(failed_row("hybrid:each", "unavailable: no device"));
  const std::string text = page_of(rows);
  EXPECT_THAT(text, HasSubstr("| Multi-thread CPU, *published* | 6.6 (2.95×) | 586.35 (4.66×) |\n"
                              "| `threads-mutex`, **measured** | **0.200** (0.500×) | – |\n"
                              "| `threads-mutex:10`, **measured** | **0.250** (0.400×) | – |\n"
                              "| `openmp`, **measured** |"));
  EXPECT_THAT(text, HasSubstr("| `hybrid:each`, **measured** | unavailable | – |\n"));
  EXPECT_THAT(text, HasSubstr("Lines with `:each`"));
}

TEST(PaperTable, SaysWherePublishedTimesAreFrom) {
  for (const char* fact : {"2016", "Nexus 7", "ten threads", "mobile GPU"})
    EXPECT_THAT(page_of(table_rows()), HasSubstr(fact));
}

TEST(PaperTable, TellsTheInstructionSetOfTheProcessorFromDevices) {
  std::vector<ResultRow> rows = table_rows();
  for (ResultRow& row : rows)
    if (row.backend == "openmp") row.device = "cpu AVX3";
  EXPECT_THAT(page_of(rows), HasSubstr("with 2 threads; AVX-512 vectors; device Some device; mssim 0.1.0"));
}

TEST(PaperTable, ShowsNoTimeThatWasNotVerified) {
  std::vector<ResultRow> rows{measured_row("openmp", 0.0125, 8.0)};
  rows[0].verified = false;
  EXPECT_THAT(page_of(rows), HasSubstr("| `openmp`, **measured** | failed |"));
  EXPECT_THAT(csv_of(rows), Not(HasSubstr("0.0125")));
}

TEST(PaperTable, MarksTimesOnMoreProcessorsThanWereAskedFor) {
  Provenance provenance = made_up_provenance();
  std::vector<ResultRow> rows = table_rows();
  for (ResultRow& row : rows) row.threads = row.backend == "hybrid" ? 2 : 1;
  const auto text = [&] { return page_of(rows, provenance); };
  EXPECT_THAT(text(), Not(HasSubstr("(!)")));
  provenance.threads = 1;
  EXPECT_THAT(text(), HasSubstr("| `hybrid` on Some device, **measured** | **0.0500** (!) (2.00×) | – |\n"));
  EXPECT_THAT(text(), HasSubstr("| `openmp`, **measured** | **0.0125** (8.00×) | – |\n"));
  EXPECT_THAT(text(), HasSubstr("\n(!) on more processors than requested: hybrid (2 instead of 1).\n"));
}

TEST(PaperTable, NamesTheDeviceThatIsTheProcessor) {
  std::vector<ResultRow> rows = table_rows();
  rows[2].device = "pthread-A Processor";
  EXPECT_THAT(page_of(rows), HasSubstr("| `hybrid` on the CPU (PoCL on A Processor), **measured** |"));
}

TEST(PaperTable, MarksARatioThatItsTimesContradict) {
  std::vector<ResultRow> rows = table_rows();
  EXPECT_THAT(page_of(rows), Not(HasSubstr("†")));
  rows[1].speedup_vs_serial = 0.9;
  EXPECT_THAT(page_of(rows), HasSubstr("| `openmp`, **measured** | **0.0125** (0.900×)† | – |\n"));
  EXPECT_THAT(page_of(rows), HasSubstr("\n\n† the two times shown contradict this ratio: "));
}

TEST(PaperTable, SaysWhyThereAreNoSpeedUps) {
  EXPECT_THAT(
      page_of({measured_row("openmp", 0.0125, std::nullopt), measured_row("hybrid", 1, std::nullopt)}),
      HasSubstr("\nspeed-ups are missing, since serial is not among the backends; add it to --backend.\n"));
  EXPECT_THAT(page_of(table_rows()), Not(HasSubstr("missing")));
}

TEST(PaperTable, ComparesFrozenIntegratorsWithThePublishedMethod) {
  std::vector<ResultRow> rows{measured_row("openmp", 0.0125, 8.0)};
  rows[0].integrator = "rk4-frozen";
  EXPECT_THAT(csv_of(rows), HasSubstr("rk4-frozen,multi-thread-cpu,openmp,published_ms,7.94\n"));
  EXPECT_THAT(page_of(rows),
              HasSubstr("## rk4-frozen: 1 force evaluation per step, compared with the published rk4\n"));
  EXPECT_THAT(page_of(rows), Not(HasSubstr("--integrator all")));
  rows[0].integrator = "rk4";
  const std::string real = page_of(rows);
  EXPECT_THAT(real, HasSubstr("## rk4: 4 force evaluations per step, compared with the published rk4\n"));
  EXPECT_THAT(real, HasSubstr("--integrator all"));
}

TEST(PaperTable, OfOtherScenesIsEmpty) {
  std::vector<ResultRow> rows{measured_row("serial", 1, 1.0)};
  rows[0].springs_published = 29000;
  EXPECT_TRUE(paper_tables(legend, published_tables())(rows, made_up_provenance()).empty());
}

}  // namespace
}  // namespace mssim
