#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;

std::vector<ResultRow> peer_rows() {
  std::vector<ResultRow> rows{measured_row("serial", 1, 1.0), measured_row("openmp", 0.125, 8.0),
                              measured_row("numba", 0.5, 2.0),
                              failed_row("jax", "unavailable: no module | jax")};
  rows[0].threads = 1;
  rows[2].note = "Numba 1.2; gather";
  return rows;
}

ResultTable peer_table_of(const std::vector<ResultRow>& rows) {
  return only_table(peer_tables()(rows, made_up_provenance()), "peers");
}

TEST(PeerTable, AsCsvHasTheRatioToOpenmpWithItsInterval) {
  std::vector<ResultRow> rows = peer_rows();
  rows[2].samples_ms = {0.5, 0.25, 0.125};  // of openmp's 0.25, 0.0625, 0.125
  EXPECT_EQ(
      table_csv(peer_table_of(rows).data),
      "scene,nodes,integrator,peer,threads,processors_used,ms_per_step,ms_per_step_low,ms_per_step_high,"
      "times_openmp,times_openmp_low,times_openmp_high,position_error,verified,status,note\n"
      "cloth2500,2500,semi-euler,serial,1,1.5,1,0.5,2,8,8,8,1e-05,true,ok,\n"
      "cloth2500,2500,semi-euler,openmp,2,1.5,0.125,0.0625,0.25,1,1,1,1e-05,true,ok,\n"
      "cloth2500,2500,semi-euler,numba,2,1.5,0.5,0.25,1,2,1,4,1e-05,true,ok,Numba 1.2; gather\n"
      "cloth2500,2500,semi-euler,jax,2,,,,,,,,,false,unavailable: no module | jax,\n");
}

TEST(PeerTable, AsMarkdownHasABlockASceneAndWhatTheySayOfThemselves) {
  std::vector<ResultRow> rows = peer_rows();
  rows.push_back(measured_row("serial", 2, 1.0));
  rows.back().scene = "box";
  const std::string page = markdown(peer_table_of(rows).page);
  EXPECT_THAT(page, HasSubstr("## cloth2500, semi-euler: 2,500 nodes, 14,502 springs\n"));
  EXPECT_THAT(page, HasSubstr("| `numba` | 2 | 1.50 | **0.500** | 4.00× | 4.00 to 4.00 | "));
  EXPECT_THAT(page, HasSubstr("| `jax` | – | – | unavailable | – | – | – |\n"));
  EXPECT_THAT(page, HasSubstr("## box, semi-euler"));
  EXPECT_THAT(page, HasSubstr("- `numba`: Numba 1.2; gather\n"));
  EXPECT_THAT(page, HasSubstr("- `jax`, `semi-euler`: unavailable: no module \\| jax"));
}

TEST(PeerTable, HasNoRatioWithoutOpenmp) {
  std::vector<ResultRow> rows = peer_rows();
  rows[1].verified = false;
  EXPECT_THAT(markdown(peer_table_of(rows).page), HasSubstr("| `numba` | 2 | 1.50 | **0.500** | – | – | "));
  rows = peer_rows();
  rows[2].samples_ms.pop_back();
  EXPECT_THAT(table_csv(peer_table_of(rows).data), HasSubstr("numba,2,1.5,0.5,0.25,1,,,,1e-05"));
}

TEST(PeerTable, ShowsNoTimeThatWasNotVerified) {
  std::vector<ResultRow> rows = peer_rows();
  rows[2].verified = false;
  const ResultTable table = peer_table_of(rows);
  EXPECT_THAT(markdown(table.page), HasSubstr("| `numba` | – | – | failed | – | – | – |"));
  EXPECT_THAT(table_csv(table.data), HasSubstr("false,failed: not verified"));
}

}  // namespace
}  // namespace mssim
