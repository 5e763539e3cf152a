#include "output/tables/table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "text/text.h"

namespace mssim {
namespace {

using nlohmann::ordered_json;

/// A number with a point or an exponent.
std::string json_number(double number) { return ordered_json(number).dump(); }
std::string four_digits(double number) { return fmt::format("{:.4g}", number); }
std::string ungrouped(std::int64_t number) { return std::to_string(number); }
std::string grouped_whole(std::int64_t number) { return grouped(static_cast<std::uint64_t>(number)); }
std::string unchanged(std::string_view text) { return std::string(text); }

/// How a format spells values.
struct CellSpelling {
  std::string_view nothing, no, yes;
  std::string (*whole)(std::int64_t number);
  std::string (*real)(double number);
  std::string (*text)(std::string_view text);
};
constexpr CellSpelling csv_file{"", "false", "true", ungrouped, csv_number, unchanged};
constexpr CellSpelling csv_listing{"", "false", "true", ungrouped, json_number, unchanged};
/// No text from a file controls the terminal.
constexpr CellSpelling terminal{"-", "no", "yes", ungrouped, four_digits, escaped};
constexpr CellSpelling page{"–", "no", "yes", grouped_whole, three_digits, unchanged};
constexpr CellSpelling exact_page{"–", "no", "yes", grouped_whole, decimal, unchanged};

/// The value, a number with its unit.
std::string value_text(const Cell& cell, const CellSpelling& how, const std::string& unit = "") {
  if (const auto* truth = std::get_if<bool>(&cell.value)) return std::string(*truth ? how.yes : how.no);
  if (const auto* number = std::get_if<std::int64_t>(&cell.value)) return how.whole(*number) + unit;
  if (const auto* number = std::get_if<double>(&cell.value)) return how.real(*number) + unit;
  if (const auto* text = std::get_if<std::string>(&cell.value)) return how.text(*text);
  return std::string(how.nothing);
}

std::string terminal_cell(const Cell& cell, const Column& column) {
  return value_text(cell, terminal, column.unit) + cell.suffix;
}

std::string csv_of(const Table& table, const CellSpelling& spelling) {
  if (table.columns.empty()) return {};
  const auto field_of = [&](const Cell& cell) { return value_text(cell, spelling); };
  std::string text = csv_line(mapped<std::string>(table.columns, &Column::name));
  for (const std::vector<Cell>& row : table.rows) text += csv_line(mapped<std::string>(row, field_of));
  return text;
}

/// Columns next to each other.
std::string terminal_text(const Table& table) {
  if (table.columns.empty()) return {};
  std::vector<std::vector<std::string>> lines{mapped<std::string>(table.columns, &Column::name)};
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) line.push_back(terminal_cell(row[i], table.columns[i]));
  }
  std::vector<std::size_t> width(table.columns.size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) width[i] = std::max(width[i], width_of(line[i]));
  std::string text;
  for (const auto& line : lines) {
    std::string padded;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string padding(width[i] - width_of(line[i]), ' ');
      if (i > 0) padded += "  ";
      padded += is_right_aligned(table, i) ? padding + line[i] : line[i] + padding;
    }
    padded.erase(padded.find_last_not_of(' ') + 1);
    text += padded + '\n';
  }
  return text;
}

std::string json_line(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

void Table::add(std::initializer_list<NamedCell> row) {
  if (columns.empty())
    for (const NamedCell& named : row) columns.push_back({std::string(named.column)});
  std::vector<Cell>& cells = rows.emplace_back();
  for (const NamedCell& named : row) cells.push_back(named.cell);
}

bool is_right_aligned(const Table& table, std::size_t column) {
  const Align align = table.columns[column].align;
  if (align != Align::by_content) return align == Align::right;
  return std::ranges::all_of(table.rows, [&](const std::vector<Cell>& row) {
    const auto& value = row[column].value;
    return !std::holds_alternative<bool>(value) && !std::holds_alternative<std::string>(value);
  });
}

std::string cell_text(const Cell& cell, const Column& column) {
  const std::string around = cell.strong ? "**" : "";
  return around + value_text(cell, cell.exact ? exact_page : page, column.unit) + around + cell.suffix;
}

std::string to_text(const Table& table, ListingFormat format) {
  if (format == ListingFormat::csv) return csv_of(table, csv_listing);
  return format == ListingFormat::json ? json_text(table_json(table)) : terminal_text(table);
}

std::string record_text(const Table& table, std::optional<int> width) {
  std::string text = terminal_text(table);
  if (!width || width_of(text.substr(0, text.find('\n'))) <= static_cast<std::size_t>(*width)) return text;
  std::size_t name_width = 0;
  for (const Column& column : table.columns) name_width = std::max(name_width, width_of(column.name));
  text.clear();
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& name = table.columns[i].name;
    const Cell& cell = table.rows.at(0)[i];
    if (std::holds_alternative<std::monostate>(cell.value)) continue;
    text += name + std::string(name_width - width_of(name) + 2, ' ') + terminal_cell(cell, table.columns[i]) +
            '\n';
  }
  return text;
}

std::string table_csv(const Table& table) { return csv_of(table, csv_file); }

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (&field != &fields.front()) line += ',';
    // Unless quoted, a byte-order mark at the start would be taken for the file's.
    if (field.find_first_of(",\"\r\n") == std::string::npos && without_byte_order_mark(field) == field) {
      line += field;
      continue;
    }
    line += '"';
    for (const char character : field) line.append(character == '"' ? 2 : 1, character);
    line += '"';
  }
  return line + '\n';
}

std::string csv_number(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("CSV: a number is not finite");
  return decimal(value);
}

ordered_json table_json(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const std::vector<Cell>& row : table.rows) {
    ordered_json& object = rows.emplace_back(ordered_json::object());
    for (std::size_t i = 0; i < row.size(); ++i)
      object[table.columns[i].name] = std::visit(
          []<class Value>(const Value& value) -> ordered_json {
            if constexpr (!std::same_as<Value, std::monostate>) return value;
            return nullptr;
          },
          row[i].value);
  }
  return rows;
}

std::string json_text(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

std::string json_rows(const Table& table) {
  return "[\n" + join(mapped<std::string>(table_json(table), json_line), ",\n") + "\n]";
}

std::string json_string(const std::string& text) { return json_line(text); }

}  // namespace mssim
