#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<RaceLegend> race_methods{{"serial", "one thread", "none", "once", "yes"},
                                           {"gather", "each node sums", "32 bytes a spring", "twice", "yes"},
                                           {"atomic", "atomic adds", "none", "once", "no"}};

std::vector<ResultRow> race_rows() {
  std::vector<ResultRow> rows{measured_row("serial", 1.5, 1.0), measured_row("gather", 0.75, 2.0),
                              failed_row("atomic", "failed: step 3 | node 7 is not finite"),
                              measured_row("hybrid", 1, 1.5), measured_row("serial", 0.25, 1.0)};
  rows.back().scene = "box";
  return rows;
}

ResultTable race_table_of(const std::vector<ResultRow>& rows) {
  return only_table(race_tables(race_methods)(rows, made_up_provenance()), "races");
}

TEST(RaceTable, AsCsvHasTimesRatiosAndWhatAWayCosts) {
  EXPECT_EQ(
      table_csv(race_table_of(race_rows()).data),
      "scene,nodes,springs_unique,integrator,method,threads,ms_per_step,ms_per_step_low,ms_per_step_high,"
      "speedup_vs_serial,extra_memory,springs_computed,same_bits,status\n"
      "cloth2500,2500,14502,semi-euler,serial,2,1.5,0.75,3,1,none,once,yes,ok\n"
      "cloth2500,2500,14502,semi-euler,gather,2,0.75,0.375,1.5,2,32 bytes a spring,twice,yes,ok\n"
      "cloth2500,2500,14502,semi-euler,atomic,2,,,,,none,once,no,failed: step 3 | node 7 is not finite\n"
      "box,2500,14502,semi-euler,serial,2,0.25,0.125,0.5,1,none,once,yes,ok\n");
}

TEST(RaceTable, AsMarkdownHasABlockASceneAndALineAWay) {
  const std::string page = markdown(race_table_of(race_rows()).page);
  EXPECT_THAT(page, HasSubstr("## cloth2500, semi-euler: 2,500 nodes, 14,502 springs\n"));
  EXPECT_THAT(page, HasSubstr("## box, semi-euler"));
  EXPECT_THAT(
      page,
      HasSubstr("| `gather` | **0.750** | 0.375 to 1.50 | 2.00× | 32 bytes a spring | twice | yes |\n"));
  EXPECT_THAT(page, HasSubstr("| `atomic` | failed | – | – | none | once | no |\n"));
  EXPECT_THAT(page, HasSubstr("- `atomic`, `semi-euler`: failed: step 3 \\| node 7"));
  EXPECT_THAT(page, HasSubstr("- `gather`: each node sums\n"));
  EXPECT_THAT(page, HasSubstr("Measured on A Processor (2 logical CPUs) with 2 threads"));
  EXPECT_THAT(page, Not(HasSubstr("hybrid")));
}

TEST(RaceTable, ShowsNoTimeThatWasNotVerified) {
  std::vector<ResultRow> rows{measured_row("gather", 0.75, 2.0)};
  rows[0].verified = false;
  const ResultTable table = race_table_of(rows);
  EXPECT_THAT(markdown(table.page), HasSubstr("| `gather` | failed | – | – |"));
  EXPECT_THAT(table_csv(table.data), HasSubstr("failed: not verified"));
}

TEST(RaceTable, MarksARatioThatItsTimesContradict) {
  std::vector<ResultRow> rows = race_rows();
  EXPECT_THAT(markdown(race_table_of(rows).page), Not(HasSubstr("†")));
  rows[1].speedup_vs_serial = 0.923;
  EXPECT_THAT(markdown(race_table_of(rows).page),
              HasSubstr("| `gather` | **0.750** | 0.375 to 1.50 | 0.923×† |"));
  EXPECT_THAT(markdown(race_table_of(rows).page),
              HasSubstr("|\n\n† the two times shown contradict this ratio: "));
}

TEST(RaceTable, IsNotMadeOfOtherBackends) {
  EXPECT_TRUE(
      race_tables(race_methods)(std::vector{measured_row("hybrid", 1, 1.0)}, made_up_provenance()).empty());
}

}  // namespace
}  // namespace mssim
