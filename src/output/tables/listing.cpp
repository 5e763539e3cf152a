#include "output/tables/listing.h"

#include <nlohmann/json.hpp>

#include "output/tables/table_csv.h"
#include "output/tables/table_json.h"
#include "output/tables/table_text.h"

namespace mssim {

std::string to_text(const Table& table, ListingFormat format) {
  switch (format) {
    case ListingFormat::csv:
      return table_csv(table, [](double number) { return nlohmann::ordered_json(number).dump(); });
    case ListingFormat::json:
      return json_text(table_json(table));
    case ListingFormat::table:
      break;
  }
  return table_text(table);
}

}  // namespace mssim
