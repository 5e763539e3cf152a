#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "text/error.h"

namespace mssim {

/// A cell: a value (nothing, truth, whole number, real, text) and how people see it. Writers for programs
/// (CSV, JSON) only use the value. Text for people may have Markdown's `code`, *emphasis* and **strong**, and
/// line feeds.
struct Cell {
  std::variant<std::monostate, bool, std::int64_t, double, std::string> value;
  bool exact = false;   ///< a real is shown with all its digits, as published; otherwise rounded
  bool strong = false;  ///< the value is emphasised
  std::string suffix;   ///< for people, after the value

  Cell() = default;
  Cell(double number) : value(number) {}
  Cell(std::string text) : value(std::move(text)) {}
  Cell(std::string_view text) : value(std::string(text)) {}
  Cell(const char* text) : value(std::string(text)) {}
  /// A bool, or a whole number below 2^63.
  template <std::integral Number>
  Cell(Number number) {
    if constexpr (std::same_as<Number, bool>)
      value = number;
    else
      value = static_cast<std::int64_t>(number);
  }
  /// The value of an optional, or nothing.
  template <class Value>
  Cell(const std::optional<Value>& optional) {
    if (optional) *this = Cell(*optional);
  }
};

/// `by_content`: right-aligned if all cells of the column are numbers or nothing.
enum class Align : std::uint8_t { by_content, left, right };

/// A column's heading and how its cells are shown.
struct Column {
  std::string name;
  Align align = Align::by_content;
  std::string unit = {};  ///< for people, after each number; programs find it in the name
};

/// Columns, and rows with a cell for each.
struct Table {
  struct NamedCell {
    std::string_view column;
    Cell cell;
  };

  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;

  /// Adds a row. The first one names the columns; later ones must have the same.
  void add(std::initializer_list<NamedCell> row);
};

/// Whether the cells of this column are right-aligned.
bool is_right_aligned(const Table& table, std::size_t column);

/// A cell as people read it, with its unit, its suffix and the marks of Markdown. Whole numbers are grouped,
/// reals have three digits unless they are exact, and nothing is a dash.
std::string cell_text(const Cell& cell, const Column& column);

/// Format of a printed table: columns for a terminal, CSV with the numbers of JSON, or a JSON array with an
/// object per row, whose keys are the columns.
enum class ListingFormat : std::uint8_t { table, csv, json };

/// The table as text, ending with a newline; a table without columns is an empty text, or an empty array. On
/// a terminal, numbers have at most four significant digits and no groups, and control characters are
/// escaped. Nothing is "-" there, empty in CSV and null in JSON.
std::string to_text(const Table& table, ListingFormat format = ListingFormat::table);

/// A table of one row for a terminal. If it is wider than `width` columns, one line per value that is not
/// empty.
std::string record_text(const Table& table, std::optional<int> width);

/// The table as in a result file: RFC 4180 CSV, but with line feeds as line ends, and reals by csv_number().
/// Throws std::invalid_argument for a number that is not finite.
std::string table_csv(const Table& table);

/// One line of such a file with its line feed; fields are quoted if necessary.
std::string csv_line(const std::vector<std::string>& fields);

/// The shortest decimal that reads back as the same number. Throws std::invalid_argument unless it is finite.
std::string csv_number(double value);

/// The table as a JSON array with an object per row, whose keys are the columns.
nlohmann::ordered_json table_json(const Table& table);

/// JSON as mssim writes it: indented by two, with a final line feed. Bytes that are not UTF-8 are replaced (a
/// file name may have any).
std::string json_text(const nlohmann::ordered_json& json);

/// table_json() with a line per row, for data that are read by programs.
std::string json_rows(const Table& table);

/// A text as a JSON string, in quotes. Bytes that are not UTF-8 are replaced.
std::string json_string(const std::string& text);

/// A page for people: a sequence of blocks. Text may have Markdown's `code`, *emphasis* and **strong**.
struct Heading {
  int level = 1;
  std::string text;
};
/// Running text.
struct Paragraph {
  std::string text;
};
/// A list with one bullet per item.
struct BulletList {
  std::vector<std::string> items;
};
/// A page: its blocks from top to bottom.
using Document = std::vector<std::variant<Heading, Paragraph, BulletList, Table>>;

/// A mark of such text.
enum class TextMark : std::uint8_t { code, strong, emphasis };

/// How a format spells text with marks.
struct TextSpelling {
  std::string (*plain)(std::string_view text);  ///< text without marks or line feeds
  std::string (*code)(std::string_view text);   ///< the content of `code`
  std::string (*marked)(TextMark mark, const std::string& spelled_content);
  std::string_view line_end;
};

/// The text in that spelling. A mark that is not closed, or has a blank after it, stands for itself.
std::string spelled(std::string_view text, const TextSpelling& spelling);

/// Adds a paragraph with the sentence and a full stop; nothing for an empty one.
void add_sentence(Document& page, const std::string& sentence);

/// The page as Markdown (with GitHub's tables), a blank line between blocks; cells as in cell_text().
/// Characters that would end a cell or a line are escaped only in cells and items.
std::string markdown(const Document& document);

/// Any text (a name, a message) as LaTeX shows it, in running text, captions and tables. pdfLaTeX has no
/// letters beyond Latin-1; others become their code points.
std::string latex_text(std::string_view text);

/// Text with the marks of a Document as LaTeX; otherwise like latex_text.
std::string latex_prose(std::string_view text);

/// The page as LaTeX for a paper that loads booktabs, siunitx and graphicx: a float for each table, the other
/// blocks as text. The page begins with its title and the sentence where it was measured; both, the heading
/// above a table and `remark`, a sentence, are its caption. `name`: letters, digits and hyphens; the labels
/// are tab:NAME-1 and so on. Cells are as in cell_text(), with numbers, ranges and units set by siunitx.
std::string latex(const Document& document, const std::string& name, const std::string& remark);

/// Parses the output of markdown(); all cells are texts. Any other text is accepted: what is not a heading,
/// list or table is a paragraph; cells that a row lacks are empty, and those beyond the head are dropped.
Document document_in(std::string_view markdown);

/// Largest CSV file, about a million samples: its fields take many times that in memory.
inline constexpr std::size_t largest_csv_bytes = std::size_t{64} << 20;

/// Thrown if a CSV file cannot be read. what() is one sentence with file, line and column, the value and the
/// remedy.
struct CsvError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// A table read from a CSV file: a header, and records with as many fields.
class CsvTable {
 public:
  /// Parses a text, which may begin with a byte-order mark; messages name `name`, its file. Throws CsvError
  /// if a quote is not closed or a record does not have the header's length.
  CsvTable(std::string name, std::string_view text);

  /// Reads the table from a file. Throws CsvError, also if the file cannot be read.
  explicit CsvTable(const std::filesystem::path& file);

  const std::vector<std::string>& header() const { return header_; }
  std::size_t size() const { return records_.size(); }
  /// Throws CsvError if the header does not begin with these columns.
  void require_columns(const std::vector<std::string_view>& columns) const;
  /// Index of the column with that name. Throws CsvError if there is none.
  std::size_t column(std::string_view name) const;

  const std::string& text(std::size_t record, std::size_t column) const {
    return records_[record].fields[column];
  }
  /// Throws CsvError unless the whole field is a finite number.
  double number(std::size_t record, std::size_t column) const;
  /// Reads a number; none for an empty field. Throws CsvError like number().
  std::optional<double> optional_number(std::size_t record, std::size_t column) const;
  /// Throws CsvError unless the whole field is a whole number from 0 to 2^53.
  std::uint64_t count(std::size_t record, std::size_t column) const;
  /// Throws CsvError unless the field is "true" or "false".
  bool truth(std::size_t record, std::size_t column) const;
  /// The CsvError for a field: "FILE, line L, column NAME: "VALUE" WHAT".
  CsvError complaint(std::size_t record, std::size_t column, const std::string& what) const;

 private:
  struct Record {
    std::size_t line = 0;  ///< of its first character, from 1
    std::vector<std::string> fields;
  };
  std::string name_;
  std::vector<std::string> header_;
  std::vector<Record> records_;
};

}  // namespace mssim
