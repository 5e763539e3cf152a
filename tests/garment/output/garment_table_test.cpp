#include "garment/output/garment_tables.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

ResultRow dressed_row(const std::string& scene, std::uint64_t nodes, const std::string& backend, double ms,
                      std::optional<double> speedup) {
  ResultRow row = measured_row(backend, ms, speedup);
  row.scene = scene;
  row.nodes = nodes;
  row.springs_published.reset();
  row.gigabytes_per_second = row.roofline_fraction = row.paper_ms = std::nullopt;
  row.dressing = {.iterations = 2000,
                  .seamed_at = 420,
                  .settled = true,
                  .simulated_s = 0.54,
                  .wall_s = 2e3 * ms,
                  .fit = {{"largest_gap_mm", 0.25, true}, {"nodes_inside", 0, {}}, {"rows_astray", 0, true}}};
  return row;
}

ResultRow row_without_time(const std::string& scene, std::uint64_t nodes, const std::string& backend,
                           const std::string& status) {
  ResultRow row = failed_row(backend, status);
  row.scene = scene;
  row.nodes = nodes;
  return row;
}

/// Larger first, as a user may name them; a cloth; what cannot; and one that does not fit.
std::vector<ResultRow> garment_rows() {
  std::vector<ResultRow> rows{dressed_row("large", 4000, "serial", 2, 1.0),
                              dressed_row("large", 4000, "openmp", 0.5, 4.0),
                              row_without_time("large", 4000, "hybrid", "unsupported: no | garments"),
                              measured_row("serial", 0.1, 1.0),
                              dressed_row("small", 1000, "serial", 0.25, 1.0),
                              dressed_row("small", 1000, "openmp", 0.125, 2.0),
                              row_without_time("small", 1000, "hybrid", "unsupported: no | garments")};
  ResultRow& misfit = rows[5];
  misfit = row_without_time("small", 1000, "openmp", "failed: dressed, the garment did not come to rest");
  misfit.dressing = {
      .iterations = 8000,
      .seamed_at = std::nullopt,
      .settled = false,
      .simulated_s = 4,
      .wall_s = 0.75,
      .fit = {{"largest_gap_mm", std::nullopt, false}, {"nodes_inside", 3, {}}, {"rows_astray", 1, false}}};
  return rows;
}

TEST(GarmentCsv, HasALineForEveryRowOfADressedSceneAndNoOther) {
  const std::string csv = garment_csv(garment_rows());
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 6);
  EXPECT_THAT(
      csv,
      AllOf(
          HasSubstr("\nlarge,4000,openmp,cpu,2,semi-euler,5e-04,0.5,0.25,1,125,4,2000,420,true,0.54,1000,500,"
                    "true,ok,0.25,true,0,0,true\n"),
          HasSubstr("\nlarge,4000,hybrid,cpu,2,semi-euler,5e-04,,,,,,,,,,,,false,unsupported: no | "
                    "garments,,,,,\n"),
          HasSubstr("\nsmall,1000,openmp,cpu,2,semi-euler,5e-04,,,,,,8000,,false,4,0.75,0.09375,false,"
                    "\"failed: dressed, the garment did not come to rest\",,false,3,1,false\n")));
}

TEST(GarmentCsv, IsEmptyWhereNothingWasDressed) {
  EXPECT_EQ(garment_csv(table_rows()), "");
  EXPECT_TRUE(garment_tables()(table_rows(), made_up_provenance()).empty());
}

TEST(GarmentCsv, ReadsBackAsItWas) {
  const std::vector<ResultRow> rows = garment_rows();
  std::vector<ResultRow> read = rows;
  for (ResultRow& row : read) row.dressing.reset();
  read_dressings(CsvTable("garment.csv", garment_csv(rows)), read);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(read[i].dressing.has_value(), rows[i].dressing.has_value()) << i;
    if (!rows[i].dressing) continue;
    const DressingRecord &now = *read[i].dressing, &before = *rows[i].dressing;
    EXPECT_EQ(now.iterations, before.iterations);
    EXPECT_EQ(now.seamed_at, before.seamed_at);
    EXPECT_EQ(now.settled, before.settled);
    EXPECT_EQ(now.simulated_s, before.simulated_s);
    EXPECT_EQ(now.wall_s, before.wall_s);
    ASSERT_EQ(now.fit.size(), before.fit.size());
    for (std::size_t n = 0; n < now.fit.size(); ++n) {
      EXPECT_EQ(now.fit[n].name, before.fit[n].name);
      EXPECT_EQ(now.fit[n].value, before.fit[n].value);
      EXPECT_EQ(now.fit[n].within, before.fit[n].within);
    }
  }
  EXPECT_EQ(garment_csv(read), garment_csv(rows));
}

TEST(GarmentCsv, SaysWhatCannotBeRead) {
  std::string csv = garment_csv(garment_rows());
  std::vector<ResultRow> rows = garment_rows();
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string changed = csv;
    changed.replace(changed.find(from), from.size(), to);
    return sentence_of<CsvError>([&] { read_dressings(CsvTable("garment.csv", changed), rows); });
  };
  EXPECT_THAT(complaint(",2000,420,true,", ",2000,420,maybe,"),
              HasSubstr("garment.csv, line 2, column settled: \"maybe\" is neither true nor false"));
  EXPECT_THAT(complaint(",2000,420,true,", ",-1,420,true,"), HasSubstr("column dressing_iterations"));
  EXPECT_THAT(complaint("seamed_at", "sewn_at"), HasSubstr("sewn_at"));
  EXPECT_THAT(complaint(",0.25,true,0,", ",wide,true,0,"), HasSubstr("column largest_gap_mm: \"wide\""));
}

ResultTable table_of(const std::vector<ResultRow>& rows) {
  const std::vector<ResultTable> tables = garment_tables()(rows, made_up_provenance());
  EXPECT_EQ(tables.size(), 1U);
  EXPECT_EQ(tables.front().name, "figure6");
  return tables.front();
}

TEST(GarmentTable, IsLaidOutAsTheFigure) {
  const std::string page = markdown(table_of(garment_rows()).page);
  EXPECT_THAT(page, HasSubstr("Measured on A Processor (2 logical CPUs) with 2 threads"));
  EXPECT_THAT(page, HasSubstr("| milliseconds per iteration | small<br>1,000 | large<br>4,000 |\n"
                              "|---|---:|---:|\n"
                              "| without: `serial` | **0.250** | **2.00** |\n"
                              "| with: `openmp` | failed | **0.500** (4.00×) |\n"));
  EXPECT_THAT(page, HasSubstr("| with: `openmp` | – | 125 |\n"));
  EXPECT_THAT(page, HasSubstr("| with: `openmp` | not settled | 1000 s<br>2,000 |\n"));
  EXPECT_THAT(page, HasSubstr("## Rows without a time\n\n"
                              "- `hybrid`, `semi-euler`: unsupported: no \\| garments (`large`, `small`)\n"
                              "- `openmp`, `semi-euler`: failed: dressed, the garment did not come to "
                              "rest (`small`)\n"));
  EXPECT_THAT(page, Not(HasSubstr("cloth2500")));
}

TEST(GarmentTable, HasNoDressingOfAWrongRow) {
  std::vector<ResultRow> rows = garment_rows();
  rows[5].dressing->settled = true;
  EXPECT_THAT(markdown(table_of(rows).page), HasSubstr("| with: `openmp` | failed | 1000 s<br>2,000 |\n"));
}

TEST(GarmentTable, SetsThePublishedAlgorithmBesideAndNamesWhatDoesNotFit) {
  std::vector<ResultRow> rows = garment_rows();
  rows.push_back(dressed_row("large", 4000, "algorithm1-simd", 3, 2.0 / 3));
  rows.push_back(dressed_row("large", 4000, "algorithm1-threads-simd:1", 3, 2.0 / 3));
  rows.push_back(dressed_row("large", 4000, "algorithm1-threads-simd", 1.5, 4.0 / 3));
  EXPECT_THAT(markdown(table_of(rows).page), Not(HasSubstr("not dressed within bounds")));
  rows.back().dressing->settled = false;
  rows.back().dressing->fit.front() = {"largest_gap_mm", 12, false};
  rows.back().note = "something else";
  const std::string page = markdown(table_of(rows).page);
  EXPECT_THAT(page, AllOf(HasSubstr("as printed, without: `algorithm1-simd` | – | **3.00**"),
                          HasSubstr("as printed, with: `algorithm1-threads-simd` | – | **1.50**"),
                          HasSubstr("as printed, with: `algorithm1-threads-simd:1` | – | **3.00**"),
                          HasSubstr("i7-4702MQ"), HasSubstr("Cortex-A17"),
                          HasSubstr("- `algorithm1-threads-simd` on `large`: it has not settled, "
                                    "largest_gap_mm is 12"),
                          Not(HasSubstr("something else"))));
  EXPECT_THAT(table_csv(table_of(rows).data),
              AllOf(HasSubstr("\nalgorithm1-simd,semi-euler,without,ms_per_iteration,,3\n"),
                    HasSubstr("\nalgorithm1-threads-simd,semi-euler,with,ms_per_iteration,,1.5\n")));
}

TEST(GarmentTable, AsCsvHasALineAQuantity) {
  EXPECT_THAT(table_csv(table_of(garment_rows()).data),
              AllOf(HasSubstr("\n,,,vertices,1000,4000\n"),
                    HasSubstr("\nserial,semi-euler,without,ns_per_iteration_and_vertex,250,500\n"),
                    HasSubstr("\nopenmp,semi-euler,with,ms_per_iteration,,0.5\n"),
                    HasSubstr("\nopenmp,semi-euler,with,speedup_vs_serial,,4\n"),
                    HasSubstr("\nopenmp,semi-euler,with,dressing_s,,1000\n"),
                    HasSubstr("\nopenmp,semi-euler,with,dressing_iterations,,2000\n")));
}

}  // namespace
}  // namespace mssim
