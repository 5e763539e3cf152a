#include "output/tables/table.h"

#include <algorithm>

namespace mssim {

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

}  // namespace mssim
