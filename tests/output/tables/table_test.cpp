#include "output/tables/table.h"

#include <nlohmann/json.hpp>

#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"
#include "text/text.h"

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
  EXPECT_EQ(json_rows(made_up_table()),
            R"([
{"name":"a|b, \"c\"\nd","nodes":4188004,"speed":20.64,"ok":true},
{"name":"`é`","nodes":null,"speed":2733.484,"ok":false}
])");
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

TEST(Table, AsTextHasNoControlCharacters) {
  Table table;
  table.add({{"name", "x\x1b[31mred\nB"}});
  EXPECT_EQ(to_text(table), "name\nx\\x1b[31mred\\x0aB\n");
  EXPECT_THAT(record_text(table, 5), HasSubstr("x\\x1b[31mred\\x0aB\n"));
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

TEST(Latex, ShowsAnyTextAsItIs) {
  EXPECT_EQ(
      latex_text("a_b%c&d #1 $2 {e} ~f^g \\h <i> \"j\" `k` [l] *m"),
      R"(a\_b\%c\&d \#1 \$2 \{e\} \textasciitilde{}f\textasciicircum{}g \textbackslash{}h )"
      R"(\textless{}i\textgreater{} \textquotedbl{}j\textquotedbl{} \textasciigrave{}k\textasciigrave{} )"
      R"({[}l] {*}m)");
  EXPECT_EQ(latex_text("--out ---- a-b ,,c''"), "-{}-{}out -{}-{}-{}-{} a-b ,{},{}c'{}'{}") << "ligatures";
  EXPECT_EQ(latex_text("2×–µ é ß Ж 字 😀 \xff\x01"),
            "2$\\times$--\\textmu{} é ß {[}U+0416] {[}U+5B57] {[}U+1F600] "
            "\\textbackslash{}xff\\textbackslash{}x01");
}

TEST(Latex, SpellsEveryCharacterThatTablesHave) {
  for (const char* room : {"src/output/tables", "src/output/guide", "src/garment/output", "src/report"})
    for (const auto& file : std::filesystem::directory_iterator(source_file(room))) {
      const std::string text = read_file(file.path());
      for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string character(clipped(std::string_view(text).substr(i), 1));
        if (character.size() < 2) continue;
        i += character.size() - 1;
        // Two marks are left out with the space after them.
        EXPECT_THAT(latex_text(character + ' '), Not(HasSubstr("U+"))) << file.path() << ": " << character;
      }
    }
}

TEST(Latex, HasTheMarksOfADocument) {
  EXPECT_EQ(latex_prose("`a_'b'` **is** *so* 5 ms\nbig, **`c`**, 2 * 3"),
            R"(\texttt{a\_\textquotesingle{}b\textquotesingle{}} \textbf{is} \emph{so} 5 ms big, )"
            R"(\textbf{\texttt{c}}, 2 {*} 3)");
}

/// The line of a cell with that text.
std::string latex_cell(const Cell& cell, const Column& column = {"head", Align::left}) {
  const std::string text = latex({Table{{column}, {{cell}}}}, "x", "");
  const std::size_t begin = text.find("\\midrule\n") + 9;
  return text.substr(begin, text.find(" \\\\\n", begin) - begin);
}

TEST(Latex, HasNumbersRangesAndUnitsOfSiunitx) {
  EXPECT_EQ(latex_cell(0.0042), "\\num{0.00420}");
  EXPECT_EQ(latex_cell(4188004), "\\num{4188004}");
  EXPECT_EQ(latex_cell(Cell()), "--");
  EXPECT_EQ(latex_cell(2.5, {"head", Align::right, "×"}), "\\num{2.50}$\\times$");
  EXPECT_EQ(latex_cell("5.4e-05‡"), "\\num{5.4e-05}\\textdaggerdbl{}");
  EXPECT_EQ(latex_cell("0.115 to 1,121"), "\\numrange{0.115}{1121}");
  EXPECT_EQ(latex_cell("**1.41** (2.95×)"), "\\textbf{\\num{1.41}} (\\num{2.95}$\\times$)");
  EXPECT_EQ(latex_cell("0.0927 s\n1,152"), "\\shortstack[l]{\\qty{0.0927}{\\second}\\\\\\num{1152}}");
  EXPECT_EQ(latex_cell("95 % interval (ms), -3.6e-05 m"),
            "\\qty{95}{\\percent} interval (\\unit{\\milli\\second}), \\qty{-3.6e-05}{\\metre}");
  for (const char* name : {"cloth10k", "2026-11-27", "v1.2", "1.2.3", "12e4567", "threads:10", "m", "s",
                           "cloth 1,5 m", "1,23,456", "1234,567"})
    EXPECT_EQ(latex_cell(name), name);
  EXPECT_EQ(latex_cell("`10`"), "\\texttt{10}") << "a name";
}

TEST(Latex, PutsOriginsIntoTheCaptionOfEachTable) {
  const Table table{{{"a_b"}, {"ms", Align::right}}, {{"[c]", 1}}};
  const Document page{Heading{1, "Times"},
                      Paragraph{"Measured on X."},
                      Paragraph{"How to read it."},
                      Heading{2, "First one"},
                      table,
                      BulletList{{"an item"}},
                      Heading{2, "Notes"},
                      Paragraph{"A note."},
                      table};
  const auto table_of = [](const std::string& section, const std::string& number) {
    return "\\begin{table}[!htbp]\n\\centering\\small\n\\caption{Times. " + section +
           ". Measured on X. 5 rounds.}\n\\label{tab:times-" + number + R"(}
\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{%
\begin{tabular}{lr}
\toprule
a\_b & \unit{\milli\second} \\
\midrule
{[}c] & \num{1} \\
\bottomrule
\end{tabular}}
\end{table}

)";
  };
  EXPECT_EQ(latex(page, "times", "5 rounds."),
            "How to read it.\n\n" + table_of("First one", "1") +
                "\\begin{itemize}\n\\item an item\n\\end{itemize}\n\n\\paragraph{Notes}\nA note.\n\n" +
                table_of("Notes", "2"));
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
