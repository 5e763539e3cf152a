#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "text/error.h"

namespace mssim {

/// What stands in a table: a value (nothing, truth, whole number, real, text), and how people see it. Writers
/// for programs (CSV, JSON) take the value alone. Text for people may have `code`, *emphasis* and **strong**
/// as Markdown has them, and line feeds.
struct Cell {
  std::variant<std::monostate, bool, std::int64_t, double, std::string> value;
  bool exact = false;   ///< a real is shown with all its digits, as published; else rounded
  bool strong = false;  ///< the value is emphasised
  std::string suffix;   ///< for people, behind the value

  Cell() = default;
  Cell(double number) : value(number) {}
  Cell(std::string text) : value(std::move(text)) {}
  Cell(std::string_view text) : value(std::string(text)) {}
  Cell(const char* text) : value(std::string(text)) {}
  /// Truth of a bool, else a whole number below 2^63.
  template <std::integral Number>
  Cell(Number number) {
    if constexpr (std::same_as<Number, bool>)
      value = number;
    else
      value = static_cast<std::int64_t>(number);
  }
  /// Nothing where there is none.
  template <class Value>
  Cell(const std::optional<Value>& optional) {
    if (optional) *this = Cell(*optional);
  }
};

/// `by_content`: to the right where all cells of the column are numbers or nothing.
enum class Align : std::uint8_t { by_content, left, right };

struct Column {
  std::string name;
  Align align = Align::by_content;
  std::string unit = {};  ///< for people, behind each number; programs read it in the name
};

/// Columns, and rows of a cell for each.
struct Table {
  struct NamedCell {
    std::string_view column;
    Cell cell;
  };

  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;

  /// Adds a row. The first one names the columns; later ones have the same.
  void add(std::initializer_list<NamedCell> row);
};

/// Are the cells of this column to be flush right?
bool is_right_aligned(const Table& table, std::size_t column);

/// A cell as people read it, with its unit, its suffix and the marks of Markdown: whole numbers are grouped,
/// reals have three digits unless they are exact, nothing is a dash.
std::string cell_text(const Cell& cell, const Column& column);

/// How a command prints a table: columns for a terminal, CSV whose numbers are JSON's, or a JSON array of an
/// object a row, whose keys are the columns.
enum class ListingFormat : std::uint8_t { table, csv, json };

/// Ends with a newline; a table without columns is empty text, or an empty array. For a terminal numbers have
/// at most four significant digits and no groups; nothing is "-" there, empty in CSV and null in JSON.
std::string to_text(const Table& table, ListingFormat format = ListingFormat::table);

/// A table of one row for a terminal. Where it is wider than `width` columns, a line for each value that
/// there is.
std::string record_text(const Table& table, std::optional<int> width);

/// The table as a result file has it: RFC 4180 CSV with line feeds alone as line ends, reals by csv_number().
/// Throws std::invalid_argument for a number that is not finite.
std::string table_csv(const Table& table);

/// One line of such a file, each field quoted where it has to be, with its line feed.
std::string csv_line(const std::vector<std::string>& fields);

/// The shortest decimal that reads back as the same number. Throws std::invalid_argument unless it is finite.
std::string csv_number(double value);

nlohmann::ordered_json table_json(const Table& table);

/// JSON as mssim writes it: indented by two, with a line feed at the end. Bytes that are no UTF-8 (a file's
/// name may hold any) are replaced.
std::string json_text(const nlohmann::ordered_json& json);

/// A text as JSON spells it, in quotes. Bytes that are no UTF-8 are replaced.
std::string json_string(const std::string& text);

/// A page for people, as blocks one below the other. Text may have `code`, *emphasis* and **strong** as
/// Markdown has them.
struct Heading {
  int level = 1;
  std::string text;
};
struct Paragraph {
  std::string text;
};
struct BulletList {
  std::vector<std::string> items;
};
using Document = std::vector<std::variant<Heading, Paragraph, BulletList, Table>>;

/// Adds a paragraph with this sentence, which lacks its full stop; nothing for an empty one.
void add_sentence(Document& page, const std::string& sentence);

/// The page as Markdown (with the tables of GitHub's), a blank line between blocks; cells as cell_text() has
/// them. What would end a cell or a line is escaped in cells and items, nowhere else.
std::string markdown(const Document& document);

/// The page that markdown() wrote, whose cells are all texts. Any other text is a page, too: what is no
/// heading, list or table is a paragraph, cells that a row lacks are empty, and those beyond the head are
/// left out.
Document document_in(std::string_view markdown);

/// A CSV file is refused beyond this size, a million samples: its fields take many times that in memory.
inline constexpr std::size_t largest_csv_bytes = std::size_t{64} << 20;

/// Thrown when a CSV file cannot be read; what() is one sentence that names file, line and column, the value
/// and what to do.
struct CsvError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// A table read from a CSV file: a header and records of as many fields.
class CsvTable {
 public:
  /// Parses a text, which may begin with a byte-order mark; `name`, of the file it came from, stands in
  /// messages. Throws CsvError when a quote is left open or a record has not the header's length.
  CsvTable(std::string name, std::string_view text);

  /// Reads the table from a file. Throws CsvError when it cannot be read, too.
  explicit CsvTable(const std::filesystem::path& file);

  const std::vector<std::string>& header() const { return header_; }
  std::size_t size() const { return records_.size(); }
  /// Throws CsvError when the header does not begin with these columns.
  void require_columns(const std::vector<std::string_view>& columns) const;
  /// Where the column of that name stands. Throws CsvError where there is none.
  std::size_t column(std::string_view name) const;

  const std::string& text(std::size_t record, std::size_t column) const {
    return records_[record].fields[column];
  }
  /// Throws CsvError unless the whole field is a finite number.
  double number(std::size_t record, std::size_t column) const;
  /// Reads a number; none for an empty field.
  std::optional<double> optional_number(std::size_t record, std::size_t column) const;
  /// Throws CsvError unless the whole field is a whole number from 0 to 2^53.
  std::uint64_t count(std::size_t record, std::size_t column) const;
  /// Throws CsvError unless the field is "true" or "false".
  bool truth(std::size_t record, std::size_t column) const;
  /// The CsvError for a field: "FILE, line L, column NAME: "VALUE" COMPLAINT".
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
