#include "report/report.h"

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "output/folders/provenance_file.h"
#include "output/guide/guide_tables.h"
#include "report/report_internal.h"
#include "tests/support/files_fixture.h"
#include "tests/support/report_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class ReportFolderTest : public TemporaryFolderTest {
 protected:
  /// A whole folder of two rows, of which a test damages a file.
  void put_run(const std::string& timings_text, const std::string& samples_text) const {
    put("timings.csv", timings_text);
    put("samples.csv", samples_text);
    put("provenance.json", provenance_text(made_up_provenance()));
  }
  ReportFolder read() const { return read_report_folder(folder()); }

  const std::vector<ResultRow> rows = serial_and_openmp_rows();
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
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("timings.csv"), HasSubstr("provenance.json")));
  EXPECT_THAT(read_report_folder(folder() / "none").problems, SizeIs(2));
}

TEST_F(ReportFolderTest, ShowsTheLinesThatCanBeRead) {
  put_run(timings.substr(0, timings.size() - 80), samples);  // ends within the last row
  ReportFolder found = read();
  ASSERT_EQ(found.rows.size(), 1U);
  EXPECT_THAT(found.problems,
              ElementsAre(AllOf(HasSubstr("line 3: has "), HasSubstr("1 row left out, 1 shown"))));

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
  EXPECT_THAT(found.problems, Contains(HasSubstr("has no row that can be shown")));
}

TEST_F(ReportFolderTest, GoesWithoutDamagedSamples) {
  put_run(timings, samples.substr(0, samples.size() / 2));
  ReportFolder found = read();
  ASSERT_EQ(found.rows.size(), 2U);
  EXPECT_THAT(found.rows[0].samples_ms, IsEmpty());
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("samples.csv")));

  put("samples.csv",
      "scene,backend,integrator,round,steps,ms_per_step\ncloth2500,serial,semi-euler,1,10,2\n");
  found = read();
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("has no samples of 2 rows")));
}

TEST_F(ReportFolderTest, SaysThatSamplesAreNotChecked) {
  std::vector<ResultRow> unchecked = rows;
  unchecked[1].note = unchecked_samples;
  put_run(timings_csv(unchecked), samples);
  const ReportFolder found = read();
  EXPECT_THAT(found.problems,
              ElementsAre(AllOf(HasSubstr("timings.csv: the samples of 1 row are not checked"),
                                HasSubstr("--resume"))));
  EXPECT_TRUE(counts(found.rows[1]));
}

TEST_F(ReportFolderTest, LeavesOutARoundThatTimingsDoNotHave) {
  std::vector<ResultRow> behind = rows;
  for (ResultRow& row : behind) --row.rounds;
  put_run(timings_csv(behind), samples);
  const ReportFolder found = read();
  EXPECT_THAT(found.problems, IsEmpty());
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    ASSERT_EQ(found.rows[i].samples_ms.size() + 1, rows[i].samples_ms.size());
    EXPECT_EQ(found.rows[i].samples_ms[0], rows[i].samples_ms[0]);
  }
}

TEST_F(ReportFolderTest, ReadsTheMeshesOfBodiesWithoutTimes) {
  put("table2.csv",
      "scene,nodes,springs_unique,springs_published,tetrahedra,smallest_dihedral_angle_deg\n"
      "box-small,700,4307,12921,3314,4.5\n");
  const ReportFolder found = read();
  EXPECT_THAT(found.problems, Not(Contains(HasSubstr("timings.csv"))));
  ASSERT_EQ(found.bodies.size(), 1U);
  EXPECT_EQ(found.bodies[0].scene, "box-small");
  EXPECT_EQ(found.bodies[0].springs_published, 12921U);
  EXPECT_EQ(found.bodies[0].tetrahedra, 3314U);
  EXPECT_EQ(found.bodies[0].smallest_dihedral_angle_deg, 4.5);
  put("table2.csv", "scene,nodes\nbox-small,-1\n");
  EXPECT_THAT(read().problems, Contains(HasSubstr("table2.csv")));
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
  EXPECT_THAT(
      found.problems,
      ElementsAre(
          EndsWith("timings.csv: ms_per_step of cloth2500, serial, semi-euler is 0, not between 1e-12 and "
                   "1e12; it is left out"),
          EndsWith("samples.csv: round 2 of cloth2500, openmp, semi-euler is -1, not between 1e-12 and 1e12; "
                   "the row's samples are left out")));
}

TEST_F(ReportFolderTest, SaysThatProvenanceIsDamaged) {
  put_run(timings, samples);
  put("provenance.json", "{\"build\": ");
  const ReportFolder found = read();
  EXPECT_FALSE(found.provenance);
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("malformed JSON")));
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
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("b.png is not a PNG")));
}

TEST_F(ReportFolderTest, NamesADamagedCurve) {
  put("timings.csv", timings);
  put("cloth2500.csv", "time_s,kinetic_j,total_j\n0,1,2\n0.1,1\n");
  const ReportFolder found = read();
  EXPECT_THAT(found.curves, IsEmpty());
  EXPECT_THAT(found.problems, Contains(AllOf(HasSubstr("cloth2500.csv"), HasSubstr("line 3"))));
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
  EXPECT_THROW(energy_curve_in("a", "time_s,kinetic_j,total_j\n0,1,nan\n"), CsvError);
  EXPECT_TRUE(energy_curve_in("a", "time_s,kinetic_j,total_j\n"));
}

WorkPoint work_point(double dt_s, std::optional<double> error) {
  WorkPoint point;
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
  guide.methods = {{find_integrator("rk4"), serial},
                   {find_integrator("xpbd"), serial, {Lack::time, "no time was left"}}};
  std::vector<WorkPoint>& points = guide.methods[0].points;
  points = {work_point(0.01, std::nullopt), work_point(0.005, 0.125), work_point(0.0025, 0.001)};
  points[0].diverged = points[1].on_front = points[2].beyond_trust = true;
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
  EXPECT_THAT(found.guide->scenes(), ElementsAre("cloth"));
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
  const std::string points = read_file(folder() / "guide.csv");
  put("guide.csv", points.substr(0, points.size() - 30));  // ends within the last row
  std::filesystem::remove(folder() / "guide.md");
  put("guide-sizes.csv", "scene,nodes\ncloth,3\n");
  const ReportFolder found = read();
  ASSERT_TRUE(found.guide);
  EXPECT_EQ(found.guide->points.size(), 3U);
  EXPECT_THAT(found.guide->page, IsEmpty());
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("1 row left out, 3 shown"), HasSubstr("guide-sizes.csv"),
                                          HasSubstr("guide-sizes.csv has no row that can be shown"),
                                          HasSubstr("what the guide recommends is not shown")));
  put("guide.csv", "garbage\n\x01\xff,\"\n");
  EXPECT_THAT(read().guide->points, IsEmpty());
  std::filesystem::remove(folder() / "guide.csv");
  EXPECT_FALSE(read().guide);
  EXPECT_THAT(read().problems, Contains(HasSubstr("timings.csv")));
}

TEST_F(GuideFolderTest, IsOneOfTheFoldersThatAFolderStandsFor) {
  EXPECT_EQ(result_folders(folder()), std::vector{folder()});
  put("above/zen5/guide.csv", "");
  put("above/zen4/timings.csv", "");
  EXPECT_EQ(result_folders(folder() / "above"),
            (std::vector{folder() / "above/zen4", folder() / "above/zen5"}));
}

TEST(Html, EscapesAllThatHasAMeaning) {
  EXPECT_EQ(html_text("<script>\"a\" & 'b'</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
  EXPECT_EQ(html_text("a\nb\x01\xff"), "a\nb\\x01\\xff");
}

TEST(Html, TurnsMarksIntoElements) {
  EXPECT_EQ(html_prose("`a*b` is **very** *good*\n`<i>`"),
            "<code>a*b</code> is <strong>very</strong> <em>good</em><br><code>&lt;i&gt;</code>");
  EXPECT_EQ(html_prose("**`x`**"), "<strong><code>x</code></strong>");
  EXPECT_EQ(html_prose("2 * 3, ` and **"), "2 * 3, ` and **");
  EXPECT_EQ(html_prose("``"), "``");
}

TEST(Html, PutsTablesIntoBoxes) {
  Table table{{{"na<me"}, {"ms", Align::by_content, " ms"}}, {}};
  table.rows = {{"a&b", 1.5}, {"c", Cell()}};
  EXPECT_THAT(html_of(table),
              AllOf(StartsWith("<div class=\"wide\" tabindex=\"0\"><table>\n"),
                    HasSubstr("<th scope=\"col\">na&lt;me</th>"),
                    HasSubstr("<th scope=\"row\">a&amp;b</th><td class=\"number\">1.50 ms</td>"),
                    HasSubstr("<td class=\"number\">–</td>")));
}

TEST(Html, ShiftsHeadings) {
  const Document document{Heading{1, "A"}, Paragraph{"b"}, Heading{2, "C"}, BulletList{{"d", "<e>"}}};
  EXPECT_EQ(html_of(document, 3),
            "<h3>A</h3>\n<p>b</p>\n<h4>C</h4>\n<ul>\n<li>d</li>\n<li>&lt;e&gt;</li>\n</ul>\n");
}

TEST(Html, LetsNoDataEndTheirElement) {
  EXPECT_EQ(html_data("x", "{\"a\": \"</script>\"}"),
            "<script type=\"application/json\" id=\"x\">\n{\"a\": \"\\u003c/script>\"}</script>\n");
}

TEST(Html, WritesBase64) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

ReportInput input_of(ReportFolder folder) {
  ReportInput input = of_papers();
  input.tables = paper_tables(legend, published_tables());
  input.folders.push_back(std::move(folder));
  return input;
}

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST_F(ReportFolderTest, TrustsNoAbsurdTime) {
  std::vector<ResultRow> bad = rows;
  bad[0].samples_ms[0] = 1e299;
  bad[0].ms_per_step_high = 1e13;
  bad[1].ms_per_step_low = 1e-300;
  bad[1].speedup_vs_serial = 1e200;
  put_run(timings_csv(bad), samples_csv(bad));
  const ReportFolder found = read();
  EXPECT_THAT(found.problems, ElementsAre(HasSubstr("ms_per_step_high of cloth2500, serial"),
                                          HasSubstr("round 1 of cloth2500, serial, semi-euler is 1e+299"),
                                          HasSubstr("ms_per_step_low of cloth2500, openmp"),
                                          HasSubstr("speedup_vs_serial of cloth2500, openmp")));
  for (const ResultRow& row : found.rows) EXPECT_TRUE(counts(row));
  EXPECT_TRUE(has(report_page(input_of(found)), "is 1e+299, not between"));
}

TEST(ReportPage, EscapesNamesOfScenesAndFolders) {
  ReportFolder folder = folder_of(serial_and_openmp_rows(), made_up_provenance());
  folder.name = "<script>alert(1)</script>";
  for (ResultRow& row : folder.rows) row.scene = "<script>alert(2)</script>";
  folder.rows[1].status = "failed: <script>alert(3)</script>";
  folder.problems = {"<script>alert(4)</script> is missing"};
  folder.provenance->machine.cpu_model = "<script>alert(5)</script>";
  folder.pictures = {{"<script>alert(6)</script>", "png"}};
  const std::string page = report_page(input_of(folder));
  EXPECT_FALSE(has(page, "<script>"));
  for (int i = 1; i <= 6; ++i) EXPECT_TRUE(has(page, "&lt;script&gt;alert(" + std::to_string(i) + ")")) << i;
}

TEST(ReportPage, ShowsAGuideSceneByScene) {
  ReportFolder folder;
  folder.name = "guide";
  EXPECT_FALSE(has(report_page(input_of(folder)), "<h2>Guide</h2>"));
  folder.guide.emplace();
  folder.guide->points = {
      {.scene = "<script>alert(1)</script>", .integrator = "rk4", .backend = "serial", .status = "no"},
      {.scene = "cloth", .integrator = "rk4", .backend = "serial", .status = "no"}};
  folder.guide->page = {Heading{1, "Which one"},    Paragraph{"Measured."}, Heading{2, "cloth: 9 nodes"},
                        Paragraph{"Take `rk4`."},   Table{{{"a"}}, {}},     Heading{3, "The front"},
                        Paragraph{"The <script>."}, Table{{{"b"}}, {}}};
  const std::string page = report_page(input_of(folder));
  EXPECT_FALSE(has(page, "<script>"));
  EXPECT_FALSE(has(page, "Which one"));
  for (const char* text : {"<p>Measured.</p>\n<h3>cloth: 9 nodes</h3>\n<p>Take "
                           "<code>rk4</code>.</p>\n<details><summary>Methods</summary>\n",
                           "<details><summary>The front</summary>\n<p>The &lt;script&gt;.</p>\n",
                           "</details>\n<h3>&lt;script&gt;alert(1)&lt;/script&gt;</h3>\n", "\"guide\": ["})
    EXPECT_TRUE(has(page, text)) << text;
  EXPECT_FALSE(has(page, "<h2>Verdict</h2>")) << "a guide has none";
  folder.rows = {measured_row("serial", 1, 1.0)};
  EXPECT_TRUE(has(report_page(input_of(folder)), "<h2>Verdict</h2>"));
  folder.rows.clear();
  folder.guide->points.clear();
  EXPECT_TRUE(has(report_page(input_of(folder)), "<h3>cloth: 9 nodes</h3>")) << "where guide.csv is damaged";
}

TEST(ReportPage, ComparesTwoFoldersAsCompareDoes) {
  ReportFolder folder = folder_of({measured_row("openmp", 1, std::nullopt)}, made_up_provenance());
  folder.name = "base";
  folder.rows[0].samples_ms = {1, 1.01, 1.02, 1.03, 1.04, 1.05, 1.06, 1.07};
  ReportInput input = input_of(folder);
  EXPECT_FALSE(has(report_page(input), "What changed"));
  input.folders.push_back(folder);
  input.folders[1].name = "next";
  for (double& ms : input.folders[1].rows[0].samples_ms) ms *= 2;
  EXPECT_TRUE(has(report_page(input), "<strong>slower</strong>"));
  input.folders[1].rows[0].samples_ms.clear();
  EXPECT_TRUE(has(report_page(input), "They have no measured combination in common"));
  EXPECT_TRUE(has(report_page(input), "Without samples in NEW: cloth2500, openmp, semi-euler."));
  EXPECT_FALSE(has(report_page(input), "Only BASE has"));
  std::swap(input.folders[0].rows, input.folders[1].rows);
  EXPECT_TRUE(has(report_page(input), "Without samples in BASE: cloth2500, openmp, semi-euler."));
  EXPECT_FALSE(has(report_page(input), "Only NEW has"));
  input.folders[1].provenance->machine.cpu_model = "Another";
  EXPECT_TRUE(has(report_page(input), "The two runs are not comparable: the CPU was A Processor"));
  input.folders[1].provenance.reset();
  EXPECT_TRUE(has(report_page(input), "not comparable: provenance.json"));
}

TEST(ReportPage, MarksRowsThatAreNotVerifiedInWords) {
  ReportFolder folder = folder_of(serial_and_openmp_rows());
  folder.rows[1].verified = false;
  const std::string page = report_page(input_of(folder));
  EXPECT_TRUE(has(page, "✓ yes"));
  EXPECT_TRUE(has(page, "✗ <strong>no</strong>"));
  EXPECT_TRUE(has(page, "! not verified</strong> 1 row failed or is not verified"));
}

TEST(ReportPage, SaysWhyARowOfAnySceneHasNoTime) {
  ReportFolder folder =
      folder_of({measured_row("serial", 1, 1.0), failed_row("opencl", "unsupported: one reason"),
                 failed_row("mine", "failed: another reason")});
  for (ResultRow& row : folder.rows) {
    row.scene = "my-own";
    row.springs_published.reset();
  }
  const std::string page = report_page(input_of(folder));
  for (const char* text : {"<em>Rows without a time</em>", "<h3>Rows without a time</h3>",
                           "<code>semi-euler</code>: unsupported: one reason",
                           "<code>semi-euler</code>: failed: another reason"})
    EXPECT_TRUE(has(page, text)) << text;
}

TEST(ReportPage, HasNoTableOfTheLargestScenesWithoutATime) {
  const std::string without = "<p>No row has a verified time.</p>\n<details>";
  ReportFolder folder = folder_of({measured_row("serial", 1, 1.0), failed_row("openmp", "failed: step 3")});
  EXPECT_FALSE(has(report_page(input_of(folder)), without));
  folder.rows[0] = failed_row("serial", "failed: step 3");
  EXPECT_TRUE(has(report_page(input_of(folder)), without));
}

TEST(ReportPage, MarksARatioThatItsTimesContradict) {
  ReportFolder folder = folder_of(
      {in_six_rounds(measured_row("serial", 1, 1.0)), in_six_rounds(measured_row("openmp", 0.5, 2.0))});
  for (ResultRow& row : folder.rows)
    row.scene_as_shipped = false;  // else a published table has the mark, too
  EXPECT_FALSE(has(report_page(input_of(folder)), "†"));
  folder.rows[1].ms_per_step = 1.01;
  EXPECT_TRUE(has(report_page(input_of(folder)), "<p>† "));
}

/// Where texts begin in a page, one after the other; a failure where one is missing or out of turn.
void expect_in_order(const std::string& page, const std::vector<std::string>& texts) {
  std::size_t at = 0;
  for (const std::string& text : texts) {
    const std::size_t found = page.find(text, at);
    ASSERT_NE(found, std::string::npos) << text;
    at = found;
  }
}

TEST(ReportPage, BeginsWithTheVerdictAndTheTimes) {
  ReportFolder folder = folder_of(serial_and_openmp_rows(), made_up_provenance());
  folder.name = "run";
  const std::string page = report_page(input_of(folder));
  expect_in_order(
      page, {"<h2>Verdict</h2>", "<h2>Times</h2>", "<h2>Machine and settings</h2>", "<h2>Speed-up</h2>"});
  EXPECT_FALSE(has(page, "What is missing or damaged"));
  expect_in_order(page, {"scope=\"col\">scene</th><th scope=\"col\" class=\"number\">ms per step</th>",
                         "scope=\"row\">cloth2500</th><td class=\"number\">1.00</td>"});
  folder.problems = {"a file is damaged"};
  expect_in_order(report_page(input_of(folder)), {"<li>a file is damaged.</li>", "<h2>Verdict</h2>"});
}

TEST(ReportPage, SaysAtTheTopOfAFolderWhatDisturbedIt) {
  ReportFolder folder = folder_of({measured_row("serial", 1, 1.0)}, made_up_provenance());
  EXPECT_FALSE(has(report_page(input_of(folder)), "When the run started"));
  folder.provenance->noise = {"other programs are running (load 9.5 over the last minute): end them"};
  expect_in_order(report_page(input_of(folder)), {"<h2>Times</h2>", "When the run started",
                                                  "(load 9.5 over the last minute).</p>", "<table>"});
  folder.rows = {measured_row("javascript", 1, 1.0)};
  EXPECT_TRUE(has(report_page(input_of(folder)), "During the run: other programs"));
}

TEST(ReportPage, PutsTheOutcomesOfSeveralFoldersSideBySide) {
  ReportFolder folder = folder_of(
      {in_six_rounds(measured_row("serial", 1, 1.0)), in_six_rounds(measured_row("openmp", 0.5, 2.0))});
  folder.name = "results/one";
  ReportInput input = input_of(folder);
  Claim& claim = input.claims.emplace_back();
  claim.says = "Threads help";
  ClaimTest& test = claim.test.emplace();
  test.scenes = "table1";
  test.fast = "openmp";
  test.slow = "serial";
  folder.name = "results/two/";
  folder.rows[1].samples_ms.clear();
  folder.rows[1].ms_per_step = folder.rows[1].ms_per_step_low = folder.rows[1].ms_per_step_high = 50;
  input.folders.push_back(folder);
  expect_in_order(report_page(input),
                  {">results/one</th><th scope=\"col\">results/two</th>", "Threads help", "held</strong>",
                   "not held</strong>", "<summary>The ratios of each folder</summary>"});
}

TEST(ReportPage, ShowsASingleSceneAsATable) {
  ReportFolder folder = folder_of(serial_and_openmp_rows(), made_up_provenance());
  const std::string page = report_page(input_of(folder));
  expect_in_order(page, {"<section id=\"speed-up\">", "<h4>semi-euler: speed-up over one thread</h4>",
                         "A Processor", "openmp, measured</td>"});
  EXPECT_FALSE(has(page, "-speed-up-semi-euler\" class=\"chart\""));
}

}  // namespace
}  // namespace mssim
