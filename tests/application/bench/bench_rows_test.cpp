#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "application/bench/bench_results.h"
#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "text/error.h"

namespace mssim {
namespace {

ResultRow row(const std::string& scene, const std::string& backend, int rounds = 3) {
  ResultRow row;
  row.scene = scene;
  row.backend = backend;
  row.integrator = "semi-euler";
  row.rounds = rounds;
  return row;
}

std::string listed(const std::vector<ResultRow>& rows) {
  std::string text;
  for (const ResultRow& row : rows) text += row.scene + row.backend + ' ';
  return text;
}

TEST(BenchRows, ReplaceAScenesRowsWhereTheyStand) {
  BenchRows rows({row("a", "1"), row("a", "2"), row("b", "1"), row("c", "1")});
  EXPECT_EQ(listed(rows.of_scene("a")), "a1 a2 ");
  EXPECT_EQ(listed(rows.of_scene("d")), "");
  rows.replace("b", {row("b", "8"), row("b", "9")});
  EXPECT_EQ(listed(rows.all()), "a1 a2 b8 b9 c1 ");
  rows.replace("a", {row("a", "3")});
  EXPECT_EQ(listed(rows.all()), "a3 b8 b9 c1 ");
  rows.replace("d", {row("d", "1"), row("d", "2")});
  EXPECT_EQ(listed(rows.all()), "a3 b8 b9 c1 d1 d2 ");
}

TEST(BenchRows, AreFinishedWhenEachHasItsRoundsOrCannotRun) {
  BenchSettings settings;
  settings.rounds = 3;
  settings.backends = {find_backend("serial"), find_backend("opencl")};
  settings.integrators = {find_integrator("semi-euler")};
  std::vector<ResultRow> rows{row("a", "serial"), row("a", "opencl")};
  EXPECT_FALSE(is_finished(settings, "a", {}));
  EXPECT_TRUE(is_finished(settings, "a", rows));
  rows[1].rounds = 2;
  EXPECT_FALSE(is_finished(settings, "a", rows));
  rows[1].status = "unavailable: no device";
  EXPECT_TRUE(is_finished(settings, "a", rows));
  rows.pop_back();
  EXPECT_THROW(is_finished(settings, "a", rows), UsageError);
}

}  // namespace
}  // namespace mssim
