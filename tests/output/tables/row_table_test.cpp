#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "output/tables/results.h"
#include "tests/support/result_fixture.h"
#include "text/text.h"

namespace mssim {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string table_of(const std::vector<ResultRow>& rows, const Terminal& terminal) {
  Provenance provenance;
  provenance.threads = 2;
  return row_table(pointers_to(rows), provenance, terminal);
}

std::size_t widest_line(const std::string& text) {
  std::istringstream lines(text);
  std::size_t widest = 0;
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, width_of(line));
  return widest;
}

TEST(RowTable, ShowsABlockForEachSceneWithBarsInOneScale) {
  const std::vector<ResultRow> all = table_rows();
  EXPECT_EQ(table_of({all.begin(), all.end() - 1}, {.width = 74, .utf8 = true}),
            "cloth2500: 2,500 nodes, 14,502 springs (29,004 as published)\n"
            "  integrator  backend  ms/step        interval  verified  speed-up\n"
            "  semi-euler  serial     0.100    0.0500–0.200  ✓         1.00×  █▏\n"
            "              openmp    0.0125  0.00625–0.0250  ✓         8.00×  █████████\n"
            "              hybrid    0.0500    0.0250–0.100  ✓         2.00×  ██▎\n"
            "              opencl                            ✗         failed\n"
            "  opencl: failed: step 3 | node 7 is not finite\n"
            "\n"
            "cloth350k: 350,000 nodes, 14,502 springs (4,188,004 as published)\n"
            "  integrator  backend  ms/step        interval  verified  speed-up\n"
            "  semi-euler  serial      1.50      0.750–3.00  ✓         1.00×  █▏\n");
}

TEST(RowTable, IsAsciiWithoutUtf8) {
  const std::string text = table_of(table_rows(), {.width = 80});
  for (const char character : text) ASSERT_LT(static_cast<unsigned char>(character), 0x80);
  EXPECT_THAT(text, HasSubstr("0.00625-0.0250  yes       8.00x  ########"));
  EXPECT_THAT(text, HasSubstr("  NO        failed\n"));
}

TEST(RowTable, HasEveryColumnWhereNothingHasToFit) {
  const std::string text = table_of(table_rows(), {});
  for (const char* header : {"threads", "interval", "published", "roofline", "error", "verified", "speed-up"})
    EXPECT_THAT(text, HasSubstr(header));
  EXPECT_THAT(text, HasSubstr("  19.475    25.0 %  1.0e-05  yes"));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
}

TEST(RowTable, FitsTheTerminal) {
  for (const int width : {60, 66, 70, 80, 100, 120, 200}) {
    const std::string text = table_of(table_rows(), {.width = width, .utf8 = true});
    EXPECT_LE(widest_line(text), static_cast<std::size_t>(width)) << text;
    EXPECT_THAT(text, HasSubstr("8.00×")) << width;
    EXPECT_THAT(text, HasSubstr("✓")) << width;
  }
}

TEST(RowTable, DropsTheDetailsThenTheBarsThenTheIntervals) {
  const auto at = [](int width) { return table_of(table_rows(), {.width = width, .utf8 = true}); };
  EXPECT_THAT(at(80), HasSubstr("█"));
  EXPECT_THAT(at(80), Not(HasSubstr("roofline")));
  EXPECT_THAT(at(68), Not(HasSubstr("█")));
  EXPECT_THAT(at(68), HasSubstr("0.0500–0.200"));
  EXPECT_THAT(at(50), Not(HasSubstr("interval")));
}

TEST(RowTable, ColoursSayNothingThatCharactersDoNot) {
  const std::string plain = table_of(table_rows(), {.width = 80, .rewrites = true, .utf8 = true});
  std::string coloured =
      table_of(table_rows(), {.width = 80, .rewrites = true, .colours = true, .utf8 = true});
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
  EXPECT_THAT(coloured, HasSubstr("\033[32m✓\033[0m"));
  EXPECT_THAT(coloured, HasSubstr("\033[31m✗\033[0m"));
  for (std::size_t at = coloured.find('\033'); at != std::string::npos; at = coloured.find('\033'))
    coloured.erase(at, coloured.find('m', at) + 1 - at);
  EXPECT_EQ(coloured, plain);
}

TEST(RowTable, MarksARowThatIsNotVerified) {
  std::vector<ResultRow> rows{measured_row("serial", 0.1, 1.0), measured_row("openmp", 0.0125, 8.0)};
  rows[1].verified = false;
  const std::string text = table_of(rows, {.width = 80, .utf8 = true});
  EXPECT_THAT(text, HasSubstr("  ✗         failed\n  openmp: failed: not verified\n"));
  EXPECT_THAT(text, Not(HasSubstr("8.00")));
}

TEST(RowTable, SaysWhyOnceForAllBackends) {
  const std::string reason = "unsupported: garments";
  const std::string text = table_of(
      {measured_row("serial", 1, 1.0), failed_row("hybrid", reason), failed_row("threads-mutex", reason)},
      {.width = 80, .utf8 = true});
  EXPECT_THAT(text, HasSubstr("  -         unsupported\n  hybrid, threads-mutex: unsupported: garments\n"));
}

TEST(RowTable, HasNoColumnOfWhatNoRowHas) {
  ResultRow row = measured_row("openmp", 1, std::nullopt);
  row.paper_ms = row.roofline_fraction = std::nullopt;
  const std::string text = table_of({row}, {});
  for (const char* header : {"  published", "roofline", "speed-up", "#"})
    EXPECT_THAT(text, Not(HasSubstr(header)));
}

TEST(RowTable, KeepsNumbersInLineBesideMarks) {
  std::vector<ResultRow> rows{measured_row("serial", 0.1, 1.0), measured_row("openmp", 0.0125, 30.0)};
  rows[1].threads = 4;
  const std::string text = table_of(rows, {.width = 80, .utf8 = true});
  EXPECT_THAT(text, HasSubstr("serial    0.100      "));
  EXPECT_THAT(text, HasSubstr("openmp   0.0125 (!)  "));
  EXPECT_THAT(text, HasSubstr(" 1.00×   "));
  EXPECT_THAT(text, HasSubstr("30.0×†  "));
}

}  // namespace
}  // namespace mssim
