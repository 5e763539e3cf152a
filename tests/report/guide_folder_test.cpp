#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "output/folders/provenance_file.h"
#include "output/guide/guide_table.h"
#include "output/tables/table.h"
#include "report/report.h"
#include "tests/support/result_fixture.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

WorkPoint work_point(double dt_s, std::optional<double> error) {
  WorkPoint point;
  point.integrator = find_integrator("rk4");
  point.backend = "serial";
  point.steps = 10;
  point.dt_s = dt_s;
  point.seconds_a_step = 3 * dt_s;
  point.evaluations = 4;
  point.position_error = error;
  return point;
}

/// Of rk4 a point that diverged, one on the front and one beyond trust; of xpbd only why there is none.
SceneGuide made_up_guide() {
  SceneGuide guide;
  guide.scene = "cloth";
  guide.trusted.horizon_s = 0.1;
  guide.trusted.why_there = "it was made up";
  const BackendInfo* serial = find_backend("serial");
  guide.methods = {{find_integrator("rk4"), serial, ""},
                   {find_integrator("xpbd"), serial, "no time was left"}};
  guide.points = {work_point(0.01, std::nullopt), work_point(0.005, 0.125), work_point(0.0025, 0.001)};
  guide.points[0].diverged = guide.points[1].on_front = guide.points[2].beyond_trust = true;
  for (const char* name : {"rk4", "xpbd"}) guide.limits.emplace_back().integrator = find_integrator(name);
  guide.sizes = {{find_integrator("rk4"), serial, 0.005, true, {{256, 1e-3}, {529, 2e-3}}, ""}};
  guide.recommendation.sentences = {"Take rk4 | serial."};
  return guide;
}

class GuideFolderTest : public TemporaryFolderTest {
 protected:
  GuideFolderTest() {
    const std::vector<SceneGuide> guides{made_up_guide()};
    for (const ResultTable& table : guide_tables(guides, made_up_provenance())) {
      put(std::string(table.name) + ".csv", table_csv(table.data));
      if (!table.page.empty()) put(std::string(table.name) + ".md", markdown(table.page));
    }
    put("provenance.json", provenance_text(made_up_provenance()));
  }
  ReportFolder read() const { return read_report_folder(folder()); }
};

TEST_F(GuideFolderTest, ReadsWhatAGuideWrote) {
  const ReportFolder found = read();
  EXPECT_THAT(found.problems, IsEmpty());
  EXPECT_THAT(found.rows, IsEmpty());
  ASSERT_TRUE(found.guide);
  EXPECT_THAT(found.guide->scenes(), testing::ElementsAre("cloth"));
  ASSERT_EQ(found.guide->points.size(), 4U);
  const GuidePoint &first = found.guide->points[0], &second = found.guide->points[1];
  EXPECT_TRUE(first.diverged);
  EXPECT_EQ(first.position_error, std::nullopt);
  EXPECT_TRUE(second.on_front);
  EXPECT_EQ(second.integrator, "rk4");
  EXPECT_EQ(second.backend, "serial");
  EXPECT_EQ(second.dt_s, 0.005);
  EXPECT_EQ(second.position_error, 0.125);
  EXPECT_EQ(second.wall_s_per_s, 3);
  EXPECT_EQ(second.force_evaluations_per_s, 800);
  EXPECT_EQ(second.status, "ok");
  EXPECT_NE(found.guide->points[2].status, "ok");
  EXPECT_EQ(found.guide->points[3].dt_s, std::nullopt);
  EXPECT_EQ(found.guide->points[3].status, "no time was left");
  ASSERT_EQ(found.guide->times.size(), 2U);
  EXPECT_EQ(found.guide->times[1].nodes, 529);
  EXPECT_EQ(found.guide->times[1].ms_per_step, 2);
  EXPECT_THAT(markdown(found.guide->page), HasSubstr("\nTake rk4 | serial.\n"));
}

TEST_F(GuideFolderTest, GoesWithoutSizes) {
  std::filesystem::remove(folder() / "guide-sizes.csv");
  const ReportFolder found = read();
  EXPECT_THAT(found.problems, IsEmpty()) << "guides of bodies have none";
  EXPECT_THAT(found.guide->times, IsEmpty());
}

TEST_F(GuideFolderTest, SaysWhatIsMissingOrDamaged) {
  const std::string points = text_of(folder() / "guide.csv");
  put("guide.csv", points.substr(0, points.size() - 30));  // ends within the last row
  std::filesystem::remove(folder() / "guide.md");
  put("guide-sizes.csv", "scene,nodes\ncloth,3\n");
  const ReportFolder found = read();
  ASSERT_TRUE(found.guide);
  EXPECT_EQ(found.guide->points.size(), 3U);
  EXPECT_THAT(found.guide->page, IsEmpty());
  EXPECT_THAT(found.problems,
              testing::ElementsAre(HasSubstr("1 row left out, 3 shown"), HasSubstr("guide-sizes.csv"),
                                   HasSubstr("guide-sizes.csv has no row that can be shown"),
                                   HasSubstr("what the guide recommends is not shown")));
  put("guide.csv", "garbage\n\x01\xff,\"\n");
  EXPECT_THAT(read().guide->points, IsEmpty());
  std::filesystem::remove(folder() / "guide.csv");
  EXPECT_FALSE(read().guide);
  EXPECT_THAT(read().problems, testing::Contains(HasSubstr("timings.csv")));
}

TEST_F(GuideFolderTest, IsOneOfTheFoldersThatAFolderStandsFor) {
  EXPECT_EQ(result_folders(folder()), std::vector{folder()});
  put("above/zen5/guide.csv", "");
  put("above/zen4/timings.csv", "");
  EXPECT_EQ(result_folders(folder() / "above"),
            (std::vector{folder() / "above/zen4", folder() / "above/zen5"}));
}

}  // namespace
}  // namespace mssim
