#include <gtest/gtest.h>

#include "output/tables/table.h"

namespace mssim {
namespace {

TEST(MarkdownReader, ReadsWhatTheWriterWrote) {
  Table table{{{"name"}, {"a | b", Align::right}}, {}};
  table.rows = {{"x|y\nz", 1.5}, {"", Cell()}};
  const Document page{Heading{1, "Title <b>"}, Paragraph{"A | b, `c`, a < b."},
                      BulletList{{"one | two", "three\nfour"}}, Heading{3, "### is a heading"}, table};
  const std::string text = markdown(page);
  const Document read = document_in(text);
  ASSERT_EQ(read.size(), page.size());
  EXPECT_EQ(markdown(read), text);
  EXPECT_EQ(std::get<Paragraph>(read[1]).text, "A | b, `c`, a < b.");
  EXPECT_EQ(std::get<Heading>(read[3]).text, "### is a heading");
  EXPECT_EQ(std::get<BulletList>(read[2]).items[1], "three\nfour");
  const Table& found = std::get<Table>(read[4]);
  EXPECT_EQ(found.columns[1].name, "a | b");
  EXPECT_EQ(found.columns[1].align, Align::right);
  EXPECT_EQ(std::get<std::string>(found.rows[0][0].value), "x|y\nz");
  EXPECT_EQ(std::get<std::string>(found.rows[0][1].value), "1.50");
}

TEST(MarkdownReader, FindsNoHtmlButLineEnds) {
  const std::string name = "\\`<img src=x>`";
  const std::string text =
      markdown({Heading{1, name}, Paragraph{name}, BulletList{{name}}, Table{{{name}}, {{name + "\n"}}}});
  std::size_t ends = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    EXPECT_EQ(text.substr(at, 4), "<br>");
    ++ends;
  }
  EXPECT_EQ(ends, 1U);
  EXPECT_EQ(markdown(document_in("\xef\xbb\xbf" + text)), text);
}

TEST(MarkdownReader, MakesAPageOfAnyText) {
  EXPECT_TRUE(document_in("").empty());
  EXPECT_TRUE(document_in("\n\n\n\n").empty());
  for (const char* paragraph :
       {"#no heading", "####### seven", "# two\nlines", "| a |", "| a |\n| b |", "|", "-", "- a\nb"}) {
    const Document page = document_in(paragraph);
    ASSERT_EQ(page.size(), 1U) << paragraph;
    ASSERT_TRUE(std::holds_alternative<Paragraph>(page[0])) << paragraph;
    EXPECT_EQ(std::get<Paragraph>(page[0]).text, paragraph);
  }
}

TEST(MarkdownReader, EveryRowHasACellForEachColumn) {
  const Document page = document_in("| a | b |\n|---|---:|\n| 1 |\n| 1 | 2 | 3 |\nno row\n|\n");
  const Table& table = std::get<Table>(page.at(0));
  ASSERT_EQ(table.rows.size(), 4U);
  for (const std::vector<Cell>& row : table.rows) EXPECT_EQ(row.size(), 2U);
}

}  // namespace
}  // namespace mssim
