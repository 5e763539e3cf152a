#include "output/tables/table_json.h"

#include <nlohmann/json.hpp>
#include <variant>

namespace mssim {
namespace {

using nlohmann::ordered_json;

struct AsJson {
  ordered_json operator()(std::monostate) const { return nullptr; }
  template <class Value>
  ordered_json operator()(const Value& value) const {
    return value;
  }
};

}  // namespace

ordered_json table_json(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const std::vector<Cell>& row : table.rows) {
    ordered_json& object = rows.emplace_back(ordered_json::object());
    for (std::size_t i = 0; i < row.size(); ++i)
      object[table.columns[i].name] = std::visit(AsJson{}, row[i].value);
  }
  return rows;
}

std::string table_json_text(const Table& table) { return json_text(table_json(table)); }

std::string json_string(const std::string& text) {
  return ordered_json(text).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string json_number(double number) { return ordered_json(number).dump(); }

std::string json_text(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace mssim
