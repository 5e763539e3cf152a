#include "output/tables/table_csv.h"

#include <cstdint>
#include <variant>
#include <vector>

namespace mssim {
namespace {

struct Field {
  std::string (*real)(double);

  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(double number) const { return real(number); }
  std::string operator()(const std::string& text) const { return text; }
};

}  // namespace

std::string table_csv(const Table& table, std::string (*real)(double)) {
  if (table.columns.empty()) return {};
  std::vector<std::string> fields;
  for (const Column& column : table.columns) fields.push_back(column.name);
  std::string text = csv_line(fields);
  for (const std::vector<Cell>& row : table.rows) {
    fields.clear();
    for (const Cell& cell : row) fields.push_back(std::visit(Field{real}, cell.value));
    text += csv_line(fields);
  }
  return text;
}

}  // namespace mssim
