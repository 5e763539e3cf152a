#include "output/tables/published.h"

#include <algorithm>

#include "platform/files.h"

namespace mssim {

PublishedTable::PublishedTable(const PublishedTableInfo& table_info)
    : PublishedTable(table_info, CsvTable(data_folder() / "published" /
                                          ("hong2016_" + std::string(table_info.name) + ".csv"))) {}

PublishedTable::PublishedTable(const PublishedTableInfo& table_info, const CsvTable& table)
    : info_(table_info) {
  // Table 3 calls its fourth column springs_published, because there the count is not the springs themselves.
  const bool counts_apart = table.header().size() > 3 && table.header()[3] == "springs_published";
  table.require_columns({"integrator", "configuration", "nodes",
                         counts_apart ? "springs_published" : "springs", "ms_per_step"});
  for (std::size_t record = 0; record < table.size(); ++record)
    times_.push_back({table.text(record, 0), table.text(record, 1), table.count(record, 2),
                      table.count(record, 3), table.number(record, 4)});
}

std::optional<double> PublishedTable::ms(std::string_view integrator, std::string_view configuration,
                                         std::uint64_t nodes,
                                         std::optional<std::uint64_t> springs_published) const {
  const auto time = std::find_if(times_.begin(), times_.end(), [&](const Time& candidate) {
    return candidate.integrator == integrator && candidate.configuration == configuration &&
           candidate.nodes == nodes && candidate.springs == springs_published;
  });
  if (time == times_.end()) return std::nullopt;
  return time->ms;
}

bool PublishedTable::has_scene(std::uint64_t nodes, std::optional<std::uint64_t> springs_published) const {
  return std::any_of(times_.begin(), times_.end(), [&](const Time& time) {
    return time.nodes == nodes && time.springs == springs_published;
  });
}

std::vector<PublishedTable> published_tables() {
  return {published_table_kinds.begin(), published_table_kinds.end()};
}

}  // namespace mssim
