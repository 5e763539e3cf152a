#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;

ResultRow row_of(const std::string& scene, std::uint64_t nodes, const std::string& backend, double ms) {
  ResultRow row = measured_row(backend, ms, 1.0);
  row.scene = scene;
  row.nodes = nodes;
  return row;
}

std::vector<ResultRow> scaling_rows() {
  std::vector<ResultRow> rows{row_of("small", 1000, "serial", 0.5), row_of("small", 1000, "openmp", 0.25),
                              row_of("large", 4'000'000, "serial", 3000),
                              row_of("large", 4'000'000, "openmp", 0)};
  rows[3] = failed_row("openmp", "unsupported: too large");
  rows[3].scene = "large";
  rows[3].nodes = 4'000'000;
  return rows;
}

ResultTable scaling_table_of(const std::vector<ResultRow>& rows) {
  return only_table(scaling_tables("small")(rows, made_up_provenance()), "scaling");
}

TEST(ScalingTable, AsCsvHasNanosecondsANodeAndTheRatioToTheSameBackendsBase) {
  EXPECT_EQ(table_csv(scaling_table_of(scaling_rows()).data),
            "integrator,backend,scene,nodes,ms_per_step,ns_per_node,ns_per_node_low,ns_per_node_high,"
            "ratio_to_small,status\n"
            "semi-euler,serial,small,1000,0.5,500,250,1000,1,ok\n"
            "semi-euler,openmp,small,1000,0.25,250,125,500,1,ok\n"
            "semi-euler,serial,large,4000000,3000,750,375,1500,1.5,ok\n"
            "semi-euler,openmp,large,4000000,,,,,,unsupported: too large\n");
}

TEST(ScalingTable, AsMarkdownHasAColumnASceneAndALineABackend) {
  const std::string page = markdown(scaling_table_of(scaling_rows()).page);
  EXPECT_THAT(page, HasSubstr("| backend | small<br>1,000 | large<br>4,000,000 |\n"));
  EXPECT_THAT(page, HasSubstr("| `serial` | **500** (1.00×) | **750** (1.50×) |\n"));
  EXPECT_THAT(page, HasSubstr("| `openmp` | **250** (1.00×) | unsupported |\n"));
  EXPECT_THAT(page, HasSubstr("- `openmp`, `semi-euler`: unsupported: too large (`large`)\n"));
}

TEST(ScalingTable, HasNoRatioWhereTheBaseHasNoTime) {
  std::vector<ResultRow> rows = scaling_rows();
  rows[0].verified = false;
  const ResultTable table = scaling_table_of(rows);
  EXPECT_THAT(markdown(table.page), HasSubstr("| `serial` | failed | **750** |\n"));
  EXPECT_THAT(table_csv(table.data), HasSubstr("serial,large,4000000,3000,750,375,1500,,ok\n"));
  EXPECT_TRUE(scaling_tables("small")({}, made_up_provenance()).empty());
}

}  // namespace
}  // namespace mssim
