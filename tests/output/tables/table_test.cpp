#include "output/tables/table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

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

}  // namespace
}  // namespace mssim
