#include "output/tables/published_bodies.h"

#include "platform/files.h"

namespace mssim {

std::vector<PublishedBody> published_bodies() {
  return published_bodies(CsvTable(data_folder() / "published/hong2016_table2.csv"));
}

std::vector<PublishedBody> published_bodies(const CsvTable& table) {
  table.require_columns({"object", "size", "nodes", "springs_published"});
  std::vector<PublishedBody> bodies;
  for (std::size_t record = 0; record < table.size(); ++record)
    bodies.push_back(
        {table.text(record, 0), table.text(record, 1), table.count(record, 2), table.count(record, 3)});
  return bodies;
}

}  // namespace mssim
