#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "output/folders/provenance_file.h"
#include "output/tables/results.h"
#include "report/report.h"
#include "tests/support/result_fixture.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class ReportFolderTest : public TemporaryFolderTest {
 protected:
  /// A whole folder of two rows, of which a test damages a file.
  void put_run(const std::string& timings_text, const std::string& samples_text) const {
    put("timings.csv", timings_text);
    put("samples.csv", samples_text);
    put("provenance.json", provenance_text(made_up_provenance()));
  }
  ReportFolder read() const { return read_report_folder(folder()); }

  const std::vector<ResultRow> rows{measured_row("serial", 1, 1.0), measured_row("openmp", 0.5, 2.0)};
  const std::string timings = timings_csv(rows), samples = samples_csv(rows);
};

TEST_F(ReportFolderTest, ReadsAWholeFolder) {
  put_run(timings, samples);
  const ReportFolder found = read();
  EXPECT_THAT(found.problems, IsEmpty());
  ASSERT_EQ(found.rows.size(), 2U);
  EXPECT_EQ(found.rows[1].samples_ms, rows[1].samples_ms);
  EXPECT_TRUE(found.provenance);
}

TEST_F(ReportFolderTest, SaysWhatAnEmptyFolderLacks) {
  const ReportFolder found = read();
  ASSERT_EQ(found.problems.size(), 2U);
  EXPECT_THAT(found.problems[0], HasSubstr("timings.csv"));
  EXPECT_THAT(found.problems[1], HasSubstr("machine and settings are not known"));
  EXPECT_THAT(read_report_folder(folder() / "none").problems, testing::SizeIs(2));
}

TEST_F(ReportFolderTest, ShowsTheLinesThatCanBeRead) {
  put_run(timings.substr(0, timings.size() - 80), samples);  // ends within the last row
  ReportFolder found = read();
  ASSERT_EQ(found.rows.size(), 1U);
  ASSERT_EQ(found.problems.size(), 1U);
  EXPECT_THAT(found.problems[0], HasSubstr("line 3: has "));
  EXPECT_THAT(found.problems[0], HasSubstr("1 row left out, 1 shown"));

  std::string with_nan = timings;
  with_nan.replace(with_nan.rfind(",0.5,"), 5, ",nan,");
  put("timings.csv", with_nan);
  found = read();
  ASSERT_EQ(found.rows.size(), 1U);
  EXPECT_EQ(found.rows[0].backend, "serial");
  EXPECT_THAT(found.problems[0], HasSubstr("\"nan\" is not a number"));

  put("timings.csv", "garbage\n\x01\xff,\"\n");
  found = read();
  EXPECT_THAT(found.rows, IsEmpty());
  EXPECT_THAT(found.problems, testing::Contains(HasSubstr("has no row that can be shown")));
}

TEST_F(ReportFolderTest, GoesWithoutDamagedSamples) {
  put_run(timings, samples.substr(0, samples.size() / 2));
  ReportFolder found = read();
  ASSERT_EQ(found.rows.size(), 2U);
  EXPECT_THAT(found.rows[0].samples_ms, IsEmpty());
  ASSERT_EQ(found.problems.size(), 1U);
  EXPECT_THAT(found.problems[0], HasSubstr("samples.csv"));

  put("samples.csv",
      "scene,backend,integrator,round,steps,ms_per_step\ncloth2500,serial,semi-euler,1,10,2\n");
  found = read();
  ASSERT_EQ(found.problems.size(), 1U);
  EXPECT_THAT(found.problems[0], HasSubstr("has no samples of 2 rows"));
}

TEST_F(ReportFolderTest, TrustsNoTimeThatIsNotAboveZero) {
  std::vector<ResultRow> bad = rows;
  bad[0].ms_per_step = 0;
  bad[1].samples_ms[1] = -1;
  put_run(timings_csv(bad), samples_csv(bad));
  const ReportFolder found = read();
  EXPECT_FALSE(counts(found.rows[0]));
  EXPECT_TRUE(counts(found.rows[1]));
  EXPECT_THAT(found.rows[1].samples_ms, IsEmpty());
}

TEST_F(ReportFolderTest, SaysThatProvenanceIsDamaged) {
  put_run(timings, samples);
  put("provenance.json", "{\"build\": ");
  const ReportFolder found = read();
  EXPECT_FALSE(found.provenance);
  ASSERT_EQ(found.problems.size(), 1U);
  EXPECT_THAT(found.problems[0], HasSubstr("malformed JSON"));
}

TEST_F(ReportFolderTest, FindsPicturesAndEnergyCurves) {
  put_run(timings, samples);
  put("a.png", "\x89PNG\r\n\x1a\nrest");
  put("b.png", "no picture");
  put("cloth2500.csv",
      "# mssim run\ntime_s,kinetic_j,elastic_j,gravitational_j,total_j\n0,1,2,3,6\n0.1,1,2,4,7\n");
  const ReportFolder found = read();
  ASSERT_EQ(found.pictures.size(), 1U);
  EXPECT_EQ(found.pictures[0].caption, "a.png");
  ASSERT_EQ(found.curves.size(), 1U);
  EXPECT_EQ(found.curves[0].total_j, (std::vector<double>{6, 7}));
  ASSERT_EQ(found.problems.size(), 1U);
  EXPECT_THAT(found.problems[0], HasSubstr("b.png is no PNG picture"));
}

TEST_F(ReportFolderTest, TakesSubfoldersForAFolderWithoutTimings) {
  EXPECT_THAT(result_folders(folder()), IsEmpty());
  put("zen5/timings.csv", timings);
  put("zen4/timings.csv", timings);
  put("notes/readme.txt", "");
  EXPECT_EQ(result_folders(folder()), (std::vector{folder() / "zen4", folder() / "zen5"}));
  put("timings.csv", timings);
  EXPECT_EQ(result_folders(folder()), std::vector{folder()});
}

TEST(EnergyCurveIn, RefusesOtherTables) {
  EXPECT_FALSE(energy_curve_in("a", ""));
  EXPECT_FALSE(energy_curve_in("a", "# only a comment"));
  EXPECT_FALSE(energy_curve_in("a", "scene,nodes\n"));
  EXPECT_FALSE(energy_curve_in("a", "time_s,kinetic_j,elastic_j\n0,1,2\n"));
  EXPECT_FALSE(energy_curve_in("a", "time_s,kinetic_j,total_j\n0,1,nan\n"));
  EXPECT_TRUE(energy_curve_in("a", "time_s,kinetic_j,total_j\n"));
}

}  // namespace
}  // namespace mssim
