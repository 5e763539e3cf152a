#include <gtest/gtest.h>

#include <string>

#include "report/report_internal.h"
#include "tests/support/result_fixture.h"

namespace mssim {
namespace {

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
  EXPECT_EQ(
      html_of(table),
      "<div class=\"wide\" tabindex=\"0\"><table>\n<thead><tr><th scope=\"col\">na&lt;me</th><th "
      "scope=\"col\" "
      "class=\"number\">ms</th></tr></thead>\n<tbody>\n<tr><th scope=\"row\">a&amp;b</th><td "
      "class=\"number\">1.50 ms</td></tr>\n<tr><th scope=\"row\">c</th><td class=\"number\">–</td></tr>\n"
      "</tbody>\n</table></div>\n");
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
  ReportInput input;
  input.legend = legend;
  input.published = published_tables();
  input.tables = paper_tables(legend, published_tables());
  input.folders.push_back(std::move(folder));
  return input;
}

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(ReportPage, EscapesNamesOfScenesAndFolders) {
  ReportFolder folder;
  folder.name = "<script>alert(1)</script>";
  folder.rows = {measured_row("serial", 1, 1.0), measured_row("openmp", 0.5, 2.0)};
  for (ResultRow& row : folder.rows) row.scene = "<script>alert(2)</script>";
  folder.rows[1].status = "failed: <script>alert(3)</script>";
  folder.problems = {"<script>alert(4)</script> is missing"};
  folder.provenance = made_up_provenance();
  folder.provenance->machine.cpu_model = "<script>alert(5)</script>";
  folder.pictures = {{"<script>alert(6)</script>", "png"}};
  const std::string page = report_page(input_of(folder));
  EXPECT_FALSE(has(page, "<script>"));
  for (int i = 1; i <= 6; ++i) EXPECT_TRUE(has(page, "&lt;script&gt;alert(" + std::to_string(i) + ")")) << i;
}

TEST(ReportPage, SaysWhatIsNotThere) {
  ReportFolder folder;
  folder.name = "empty";
  const std::string page = report_page(input_of(folder));
  for (const char* sentence :
       {"No folder says on which machine", "There is no row to judge", "There are no rows",
        "No row of this folder belongs into a published table", "No folder has a scene of the papers",
        "No folder has two sizes", "No folder has rows with a roofline", "No folder has an energy curve",
        "No folder has a picture", "provenance.json is missing"})
    EXPECT_TRUE(has(page, sentence)) << sentence;
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
  EXPECT_FALSE(has(page, "There is no row to judge")) << "a guide has none";
  folder.rows = {measured_row("serial", 1, 1.0)};
  EXPECT_TRUE(has(report_page(input_of(folder)), "<h2>Verdict</h2>"));
  folder.rows.clear();
  folder.guide->points.clear();
  EXPECT_TRUE(has(report_page(input_of(folder)), "<h3>cloth: 9 nodes</h3>")) << "where guide.csv is damaged";
}

TEST(ReportPage, ComparesTwoFoldersAsCompareDoes) {
  ReportFolder folder;
  folder.name = "base";
  folder.rows = {measured_row("openmp", 1, std::nullopt)};
  folder.rows[0].samples_ms = {1, 1.01, 1.02, 1.03, 1.04, 1.05, 1.06, 1.07};
  folder.provenance = made_up_provenance();
  ReportInput input = input_of(folder);
  EXPECT_FALSE(has(report_page(input), "What changed"));
  input.folders.push_back(folder);
  input.folders[1].name = "next";
  for (double& ms : input.folders[1].rows[0].samples_ms) ms *= 2;
  EXPECT_TRUE(has(report_page(input), "<strong>slower</strong>"));
  input.folders[1].rows[0].samples_ms.clear();
  EXPECT_TRUE(has(report_page(input), "They have no measured combination in common"));
  input.folders[1].provenance->machine.cpu_model = "Another";
  EXPECT_TRUE(has(report_page(input), "The two runs are not comparable: the CPU was A Processor"));
  input.folders[1].provenance.reset();
  EXPECT_TRUE(has(report_page(input), "not both folders say where they come from"));
}

TEST(ReportPage, MarksRowsThatAreNotVerifiedInWords) {
  ReportFolder folder;
  folder.rows = {measured_row("serial", 1, 1.0), measured_row("openmp", 0.5, 2.0)};
  folder.rows[1].verified = false;
  const std::string page = report_page(input_of(folder));
  EXPECT_TRUE(has(page, "✓ yes"));
  EXPECT_TRUE(has(page, "✗ <strong>no</strong>"));
  EXPECT_TRUE(has(page, "! not verified</strong> 1 row is not verified"));
}

}  // namespace
}  // namespace mssim
