#include "output/tables/listing.h"

#include "output/tables/table_csv.h"
#include "output/tables/table_json.h"
#include "output/tables/table_text.h"

namespace mssim {

std::string to_text(const Table& table, ListingFormat format) {
  switch (format) {
    case ListingFormat::csv:
      return table_csv(table, json_number);
    case ListingFormat::json:
      return table_json_text(table);
    case ListingFormat::table:
      break;
  }
  return table_text(table);
}

}  // namespace mssim
