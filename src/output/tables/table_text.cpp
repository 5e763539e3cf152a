#include "output/tables/table_text.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <variant>

#include "text/text.h"

namespace mssim {
namespace {

struct Shown {
  const std::string& unit;

  std::string operator()(std::monostate) const { return "-"; }
  std::string operator()(bool truth) const { return truth ? "yes" : "no"; }
  std::string operator()(std::int64_t number) const { return std::to_string(number) + unit; }
  std::string operator()(double number) const {
    std::ostringstream text;
    text.precision(4);
    text << number << unit;
    return text.str();
  }
  std::string operator()(const std::string& text) const { return text; }
};

}  // namespace

std::string table_text(const Table& table) {
  if (table.columns.empty()) return {};
  std::vector<std::vector<std::string>> lines{{}};
  for (const Column& column : table.columns) lines.front().push_back(column.name);
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i)
      line.push_back(std::visit(Shown{table.columns[i].unit}, row[i].value) + row[i].suffix);
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

std::string record_text(const Table& table, std::optional<int> width) {
  std::string text = table_text(table);
  if (!width || width_of(text.substr(0, text.find('\n'))) <= static_cast<std::size_t>(*width)) return text;
  std::size_t name_width = 0;
  for (const Column& column : table.columns) name_width = std::max(name_width, width_of(column.name));
  text.clear();
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto& [name, align, unit] = table.columns[i];
    const Cell& cell = table.rows.at(0)[i];
    if (std::holds_alternative<std::monostate>(cell.value)) continue;
    text += name + std::string(name_width - width_of(name) + 2, ' ') + std::visit(Shown{unit}, cell.value) +
            cell.suffix + '\n';
  }
  return text;
}

}  // namespace mssim
