#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "output/tables/results.h"

namespace mssim {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

ComparedRow row_of(const std::string& backend, std::optional<double> new_ms,
                   std::optional<RatioEstimate> ratio, Verdict verdict) {
  return {"cloth2500", backend, "semi-euler", 1, new_ms, ratio, verdict, {}, ""};
}

RunComparison made_up_comparison() {
  RunComparison comparison;
  comparison.rows = {row_of("openmp", 2, RatioEstimate{2, 1.75, 2.25, true, 1e-6}, Verdict::slower),
                     row_of("serial", 1, RatioEstimate{1, 0.99, 1.01, true, 1}, Verdict::same),
                     row_of("opencl", std::nullopt, std::nullopt, Verdict::lost),
                     row_of("hybrid", 1.01, RatioEstimate{1.01, 0.5, 2, true, 0.5}, Verdict::undecided)};
  comparison.rows[2].reason = "failed: a | b";
  comparison.rows[3].samples_needed = 40;
  comparison.means = {{"", 3, 1.25}, {"openmp", 1, 2}};
  return comparison;
}

TEST(ComparisonTable, HoldsEveryRowInEveryFormat) {
  const RunComparison comparison = made_up_comparison();
  const std::string table = to_text(comparison, ComparisonFormat::table);
  EXPECT_THAT(table, ContainsRegex("cloth2500  openmp   semi-euler +1 +2 +2 +1.75 +2.25 +1e-06  slower"));
  EXPECT_THAT(table, ContainsRegex("hybrid .*undecided  40 samples a side would decide"));
  EXPECT_THAT(table, ContainsRegex("\n\nbackend  rows  geometric_mean_ratio\nall +3 +1.25\nopenmp +1 +2\n$"));
  EXPECT_EQ(
      to_text(comparison, ComparisonFormat::markdown),
      "| scene | backend | integrator | BASE ms | NEW ms | NEW / BASE | 95 % interval | verdict |\n"
      "|---|---|---|---:|---:|---:|---|---|\n"
      "| cloth2500 | `openmp` | semi-euler | 1.00 | 2.00 | 2.00 | 1.75 to 2.25 | **slower** |\n"
      "| cloth2500 | `serial` | semi-euler | 1.00 | 1.00 | 1.00 | 0.990 to 1.01 | same |\n"
      "| cloth2500 | `opencl` | semi-euler | 1.00 | – | – | – | **lost**: failed: a \\| b |\n"
      "| cloth2500 | `hybrid` | semi-euler | 1.00 | 1.01 | 1.01 | 0.500 to 2.00 | undecided: 40 samples a "
      "side would decide |\n"
      "\n"
      "| geometric mean of | rows | NEW / BASE |\n"
      "|---|---:|---:|\n"
      "| all | 3 | 1.25 |\n"
      "| `openmp` | 1 | 2.00 |\n");
  const nlohmann::json json = nlohmann::json::parse(to_text(comparison, ComparisonFormat::json));
  EXPECT_EQ(json["regression"], true);
  EXPECT_EQ(json["threshold"], comparison.threshold);
  ASSERT_EQ(json["rows"].size(), 4U);
  EXPECT_EQ(json["rows"][0]["ratio"], 2.0);
  EXPECT_EQ(json["rows"][1]["verdict"], "same");
  EXPECT_EQ(json["rows"][2]["verdict"], "lost");
  EXPECT_EQ(json["rows"][2]["ratio"], nullptr);
  EXPECT_EQ(json["geometric_means"][0]["backend"], "all");
}

TEST(ComparisonTable, MarksARatioThatItsTimesContradict) {
  RunComparison comparison = made_up_comparison();
  for (const auto format : {ComparisonFormat::table, ComparisonFormat::markdown})
    EXPECT_THAT(to_text(comparison, format), Not(HasSubstr("†")));
  comparison.rows[0].new_ms = 0.98;
  EXPECT_THAT(to_text(comparison, ComparisonFormat::table), HasSubstr("\n† the two times shown contradict"));
  EXPECT_THAT(to_text(comparison, ComparisonFormat::markdown), HasSubstr("| 0.980 | 2.00† | 1.75 to 2.25 |"));
  EXPECT_THAT(to_text(comparison, ComparisonFormat::json), Not(HasSubstr("†")));
}

}  // namespace
}  // namespace mssim
