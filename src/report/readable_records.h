#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {

/// The records of a file's text, as `read` makes them of a table: all, or where that throws CsvError, each
/// line that can be read alone; then a problem says why, and how many are left out. So does one where there
/// are none.
template <class Record>
std::vector<Record> readable_records(const std::filesystem::path& file, std::string_view text,
                                     std::vector<Record> (*read)(const CsvTable&),
                                     std::vector<std::string>& problems) {
  std::vector<Record> records;
  try {
    records = read(CsvTable(file.string(), text));
  } catch (const CsvError& error) {
    const std::size_t head = std::min(text.find('\n'), text.size());
    const std::string header(text.substr(0, head));
    std::string_view rest = text.substr(std::min(head + 1, text.size()));
    std::size_t lost = 0;
    while (!rest.empty()) {
      const std::size_t length = std::min(rest.find('\n'), rest.size());
      std::string line = header + '\n';
      line.append(rest.substr(0, length)) += '\n';
      rest.remove_prefix(std::min(length + 1, rest.size()));
      try {
        for (Record& record : read(CsvTable(file.string(), line))) records.push_back(std::move(record));
      } catch (const CsvError&) {
        ++lost;
      }
    }
    problems.push_back(std::string(error.what()) + "; " + pluralize(lost, "row") + " left out, " +
                       std::to_string(records.size()) + " shown");
  }
  if (records.empty()) problems.push_back(file.string() + " has no row that can be shown");
  return records;
}

}  // namespace mssim
