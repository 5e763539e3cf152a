#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::Not;

ResultRow row_in_ranks(const std::string& scene, std::uint64_t nodes, const std::string& backend, int ranks,
                       double ms) {
  ResultRow row = measured_row(backend, ms, 1.0);
  row.scene = scene;
  row.nodes = nodes;
  row.threads = ranks;
  row.ms_per_step_low = row.ms_per_step_high = ms;
  row.packing_share = 0;
  row.messages_per_step = 0;
  row.bytes_per_step = 0;
  return row;
}

/// 100 x 100 nodes, shared by two processes and twice as wide: two columns of 100 nodes are 4,800 bytes.
std::vector<ResultRow> cluster_of_two() {
  std::vector<ResultRow> rows{
      row_in_ranks("square", 10'000, "openmp", 1, 1.75), row_in_ranks("square", 10'000, "mpi:1", 1, 1.8),
      row_in_ranks("square", 10'000, "mpi:2", 2, 1.25), row_in_ranks("square", 10'000, "mpi-copies:2", 2, 2),
      row_in_ranks("square-x2", 20'000, "mpi:2", 2, 2.5)};
  for (ResultRow* row : {&rows[2], &rows[4]}) {
    row->note = "Open MPI v4.1.4, 2 ranks of 1 thread, AVX3, 1 step an exchange";
    row->messages_per_step = 1;
    row->bytes_per_step = 4800;
    row->latency_us = 100;
    row->link_gigabytes_per_second = 0.048;
  }
  return rows;
}

Provenance provenance_of_two() {
  Provenance provenance = made_up_provenance();
  provenance.backend_programs = {
      {.name = "mpi-copies:2", .ranks = 2}, {.name = "mpi:1", .ranks = 1}, {.name = "mpi:2", .ranks = 2}};
  return provenance;
}

std::vector<ResultTable> tables_of_two(const std::vector<ResultRow>& rows) {
  return cluster_tables({{"semi-euler", 1}})(rows, provenance_of_two());
}

std::vector<std::string> column_of_two(std::string_view name) {
  const CsvTable table("cluster.csv", table_csv(tables_of_two(cluster_of_two()).front().data));
  std::vector<std::string> values;
  for (std::size_t row = 0; row < table.size(); ++row) values.push_back(table.text(row, table.column(name)));
  return values;
}

TEST(ClusterTable, TellsWideScenesFromOthers) {
  EXPECT_EQ(wide_scene("cloth10k-x4").base, "cloth10k");
  EXPECT_EQ(wide_scene("cloth10k-x4").times, 4);
  for (const std::string_view scene : {"cloth10k", "cloth-x1", "cloth-xl", "jeans4k-hip88", "a-x"}) {
    EXPECT_EQ(wide_scene(scene).base, scene);
    EXPECT_EQ(wide_scene(scene).times, 1);
  }
}

TEST(ClusterTable, HoldsEveryRowAgainstOneProcessAndAgainstCopies) {
  using testing::ElementsAre;
  // openmp, one rank, two ranks, two copies, two ranks on twice the scene
  EXPECT_THAT(column_of_two("ranks"), ElementsAre("0", "1", "2", "2", "2"));
  EXPECT_THAT(column_of_two("efficiency"), ElementsAre("", "1", "0.72", "", "0.72"));
  EXPECT_THAT(column_of_two("efficiency_against_copies"), ElementsAre("", "", "0.8", "", "0.8"));
  // Half of the 2 ms of a copy, or all of it, 0.1 ms of latency, and 4,800 bytes at 0.048 GB/s.
  const std::vector<std::string> modelled = column_of_two("modelled_ms_per_step");
  EXPECT_THAT(modelled, ElementsAre("", "", testing::_, "", testing::_));
  EXPECT_NEAR(std::stod(modelled[2]), 1 + 0.1 + 0.1, 1e-12);
  EXPECT_NEAR(std::stod(modelled[4]), 2 + 0.1 + 0.1, 1e-12);
}

TEST(ClusterTable, AsCsvHasSharesEfficienciesAndTheModel) {
  const std::string csv = table_csv(tables_of_two(cluster_of_two()).front().data);
  EXPECT_THAT(csv, HasSubstr("scaling,scene,nodes,integrator,backend,ranks,threads,ms_per_step,"));
  EXPECT_THAT(csv, HasSubstr("\nstrong,square,10000,semi-euler,mpi:2,2,2,1.25,1.25,1.25,0.9375,0,0.0625,4800,"
                             "1,100,0.048,0.72,0.8,1.2"));
  EXPECT_THAT(csv, HasSubstr("\nweak,square-x2,20000,semi-euler,mpi:2,2,2,2.5,"));
  EXPECT_THAT(csv, HasSubstr("\ncopies,square,10000,semi-euler,mpi-copies:2,"));
  EXPECT_THAT(csv, HasSubstr("\none process,square,10000,semi-euler,openmp,0,1,1.75,"));
}

TEST(ClusterTable, AsAPageHasBothScalingsAndSaysHowGoodTheModelIs) {
  const std::string page = markdown(tables_of_two(cluster_of_two()).front().page);
  EXPECT_THAT(page, HasSubstr("10,000 nodes for all processes (strong scaling)"));
  EXPECT_THAT(page, HasSubstr("10,000 nodes a process (weak scaling)"));
  EXPECT_THAT(page, HasSubstr("within 12 % of the measured time in all 2 rows"));
  EXPECT_THAT(page,
              HasSubstr("| `mpi:2` on `square-x2` | **2.50** | 2.50 to 2.50 | 93.8 | 0.0 | 6.2 | 4,800 | "
                        "1.00 | 0.72 | 0.80 | 2.20 (0.880×) |"));
}

TEST(ClusterTable, HasNoNumbersOfRowsThatDoNotCount) {
  std::vector<ResultRow> rows = cluster_of_two();
  rows[1].verified = false;
  rows[3] = failed_row("mpi-copies:2", "not timed: 2 ranks of 1 thread on 1 processor of a machine");
  rows[3].scene = "square";
  const std::vector<ResultTable> tables = tables_of_two(rows);
  ASSERT_EQ(tables.size(), 1U) << "estimates need the rate of a machine";
  const std::string page = markdown(tables.front().page);
  EXPECT_THAT(page, HasSubstr("| `mpi:1` | failed |"));
  EXPECT_THAT(page, HasSubstr("| `mpi-copies:2` | not timed |"));
  EXPECT_THAT(page, Not(HasSubstr("The model is within")));
}

TEST(ClusterEstimates, SayWhatManyMachinesDoAndWhereDeepHalosAndBlocksPay) {
  const std::vector<ResultTable> tables = tables_of_two(cluster_of_two());
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[1].name, "cluster-estimates");
  const std::string page = markdown(tables[1].page);
  EXPECT_THAT(page, HasSubstr("Its 2 processors together took 100 ns a node and step of `semi-euler` "
                              "(`mpi-copies:2`, `square`)"));
  EXPECT_THAT(page, HasSubstr("has 64 processors"));
  EXPECT_THAT(page, HasSubstr("ms, estimated"));
  EXPECT_THAT(page, HasSubstr("10^10 nodes: several steps an exchange pay "));
  const std::string csv = table_csv(tables[1].data);
  EXPECT_THAT(csv, HasSubstr("estimated_ms_columns,"));
  // 10^8 nodes at 100 * 2 / 64 ns on ten machines.
  EXPECT_THAT(csv, HasSubstr(",10000,10000,10,31.25,31.25,1,1,"));
  // There are no parts of a column each.
  EXPECT_THAT(csv, testing::ContainsRegex(",10000,10000,10000,[0-9.e-]+,,,,[0-9]"));
}

}  // namespace
}  // namespace mssim
