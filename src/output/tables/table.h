#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

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

}  // namespace mssim
