#include "application/console.h"

#include <gtest/gtest.h>

#include "text/text.h"

namespace mssim {
namespace {

const Progress half{"cloth2500", 1, 2, "round 8/15: midpoint openmp", 0.5, 65.2};

TEST(ProgressText, HasABarWhereThereIsRoom) {
  EXPECT_EQ(progress_text(half, 87, false),
            "cloth2500 (1 of 2)  [######      ]  about 1:05 left  round 8/15: midpoint openmp");
  EXPECT_EQ(progress_text(half, 87, true),
            "cloth2500 (1 of 2)  [██████      ]  about 1:05 left  round 8/15: midpoint openmp");
}

TEST(ProgressText, HasAPercentageInANarrowTerminal) {
  EXPECT_EQ(progress_text(half, 78, true),
            "cloth2500 (1 of 2)  50 %  about 1:05 left  round 8/15: midpoint openmp");
}

TEST(ProgressText, NeverTakesTheLastColumn) {
  for (const int width : {1, 2, 10, 20, 40, 60, 80, 120}) {
    EXPECT_LT(width_of(progress_text(half, width, true)), static_cast<std::size_t>(std::max(width, 2)));
    EXPECT_LT(width_of(progress_text(half, width, false)), static_cast<std::size_t>(std::max(width, 2)));
  }
}

TEST(ProgressText, SaysNothingOfTimeWhileNobodyKnowsIt) {
  const Progress begun{"mine", 1, 1, "references", 0, {}};
  EXPECT_EQ(progress_text(begun, 40, true), "mine   0 %  references");
}

TEST(ProgressText, KeepsItsPlacesWhateverTheActivity) {
  Progress other = half;
  other.activity = "drape";
  const std::string text = progress_text(half, 80, true);
  EXPECT_EQ(progress_text(other, 80, true).find("about"), text.find("about"));
}

}  // namespace
}  // namespace mssim
