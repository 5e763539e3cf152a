#include "output/tables/table.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace mssim {
namespace {

/// Every kind of value, and text that would end a cell, a field or a line.
Table made_up_table() {
  Cell speed = 20.64;
  speed.strong = true;
  speed.suffix = " (!)";
  Cell exact = 2733.484;
  exact.exact = true;
  Table table;
  table.add({{"name", "a|b, \"c\"\nd"}, {"nodes", std::uint64_t{4188004}}, {"speed", speed}, {"ok", true}});
  table.add({{"name", "`é`"}, {"nodes", std::optional<int>()}, {"speed", exact}, {"ok", false}});
  table.columns[2].unit = "×";
  return table;
}

TEST(Table, AsCsvHasValuesAloneAndQuotesWhatNeedsIt) {
  EXPECT_EQ(table_csv(made_up_table()),
            "name,nodes,speed,ok\n\"a|b, \"\"c\"\"\nd\",4188004,20.64,true\n`é`,,2733.484,false\n");
  EXPECT_EQ(table_csv({}), "");
  EXPECT_EQ(table_csv({{{"alone"}}, {}}), "alone\n");
  EXPECT_THROW(table_csv({{{"x"}}, {{std::numeric_limits<double>::infinity()}}}), std::invalid_argument);
}

TEST(Table, AsJsonIsAnObjectARow) {
  EXPECT_EQ(table_json(made_up_table()).dump(),
            R"([{"name":"a|b, \"c\"\nd","nodes":4188004,"speed":20.64,"ok":true},)"
            R"({"name":"`é`","nodes":null,"speed":2733.484,"ok":false}])");
  EXPECT_EQ(table_json({}).dump(), "[]");
  EXPECT_EQ(json_text({{"name", "\xff"}}), "{\n  \"name\": \"\xef\xbf\xbd\"\n}\n");
}

TEST(Table, AsTextIsAligned) {
  Table table = made_up_table();
  table.rows[0][0] = "plain";
  EXPECT_EQ(to_text(table),
            "name     nodes       speed  ok\n"
            "plain  4188004  20.64× (!)  yes\n"
            "`é`          -       2733×  no\n");
  EXPECT_EQ(to_text({}), "");
}

TEST(Table, OfOneRowIsTurnedWhereItIsTooWide) {
  Table table = made_up_table();
  table.rows.resize(1);
  table.rows[0][0] = "plain";
  table.rows[0][1] = Cell();
  EXPECT_EQ(record_text(table, {}), to_text(table));
  EXPECT_EQ(record_text(table, 32), to_text(table));
  EXPECT_EQ(record_text(table, 20),
            "name   plain\n"
            "speed  20.64× (!)\n"
            "ok     yes\n");
}

TEST(Table, AsMarkdownGroupsRoundsAndEscapes) {
  EXPECT_EQ(markdown({made_up_table()}),
            "| name | nodes | speed | ok |\n"
            "|---|---:|---:|---|\n"
            "| a\\|b, \"c\"<br>d | 4,188,004 | **20.6×** (!) | yes |\n"
            "| `é` | – | 2733.484× | no |\n");
}

TEST(Table, AlignsAsTheColumnSaysOrByItsCells) {
  Table table{{{"a"}, {"b", Align::left}, {"c", Align::right}}, {{1, 2, "text"}, {{}, {}, {}}}};
  EXPECT_TRUE(is_right_aligned(table, 0));
  EXPECT_FALSE(is_right_aligned(table, 1));
  EXPECT_TRUE(is_right_aligned(table, 2));
  table.rows[1][0] = false;
  EXPECT_FALSE(is_right_aligned(table, 0));
}

TEST(Document, AsMarkdownHasABlankLineBetweenBlocks) {
  Document page{Heading{1, "Title"}, Paragraph{"A | b."}, BulletList{{"one | two", "three\nfour"}},
                Heading{2, "Part"}};
  add_sentence(page, "");
  add_sentence(page, "The end");
  EXPECT_EQ(markdown(page), "# Title\n\nA | b.\n\n- one \\| two\n- three<br>four\n\n## Part\n\nThe end.\n");
}

TEST(Listing, HasJsonsNumbersInCsv) {
  Table table;
  table.add({{"ratio", 1.0}, {"dt_s", 1e-4}});
  EXPECT_EQ(to_text(table, ListingFormat::csv), "ratio,dt_s\n1.0,0.0001\n");
  EXPECT_EQ(to_text(table, ListingFormat::table), "ratio    dt_s\n    1  0.0001\n");
  EXPECT_EQ(to_text({}, ListingFormat::json), "[]\n");
}

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
