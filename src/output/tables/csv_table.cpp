#include <algorithm>
#include <cmath>

#include "bench/results/result.h"
#include "output/tables/table.h"
#include "platform/files.h"
#include "text/text.h"

namespace mssim {

CsvTable::CsvTable(const std::filesystem::path& file)
    : CsvTable(file.string(),
               read_file_or<CsvError>(file, "give a file that mssim wrote", largest_csv_bytes)) {}

CsvTable::CsvTable(std::string name, std::string_view text) : name_(std::move(name)) {
  text = without_byte_order_mark(text);
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size();) {
    Record record{line, {std::string()}};
    bool in_quotes = false, ended = false;
    for (; at < text.size() && !ended; ++at) {
      const char character = text[at];
      if (character == '\n') ++line;
      if (in_quotes) {
        if (character != '"') {
          record.fields.back() += character;
        } else if (at + 1 < text.size() && text[at + 1] == '"') {
          record.fields.back() += text[++at];
        } else {
          in_quotes = false;
        }
      } else if (character == '"') {
        in_quotes = true;
      } else if (character == ',') {
        record.fields.emplace_back();
      } else if (character == '\n') {
        ended = true;
      } else if (character != '\r') {
        record.fields.back() += character;
      }
    }
    if (in_quotes)
      throw CsvError("{}, line {}: a quoted field does not end; close it with a quotation mark", name_,
                     record.line);
    if (header_.empty()) {
      header_ = std::move(record.fields);
      continue;
    }
    if (record.fields.size() != header_.size())
      throw CsvError("{}, line {}: has {}, but the header has {}; add the missing ones, or remove the line",
                     name_, record.line, pluralize(record.fields.size(), "field"), header_.size());
    records_.push_back(std::move(record));
  }
}

void CsvTable::require_columns(const std::vector<std::string_view>& columns) const {
  for (std::size_t column = 0; column < columns.size(); ++column)
    if (column >= header_.size() || header_[column] != columns[column])
      throw CsvError(
          "{}, line 1: column {} is {} instead of \"{}\"; give a file that mssim wrote", name_, column + 1,
          column < header_.size() ? "\"" + printable(header_[column]) + "\"" : "missing", columns[column]);
}

std::size_t CsvTable::column(std::string_view name) const {
  const auto found = std::ranges::find(header_, name);
  if (found == header_.end())
    throw CsvError("{}, line 1: there is no column {}; use a version of mssim that writes it", name_, name);
  return static_cast<std::size_t>(found - header_.begin());
}

CsvError CsvTable::complaint(std::size_t record, std::size_t column, const std::string& what) const {
  return CsvError{
      "{}, line {}, column {}: \"{}\" {}", name_, records_[record].line, printable(header_[column]),
      printable(text(record, column)),     what};
}

double CsvTable::number(std::size_t record, std::size_t column) const {
  const auto value = number_in<double>(text(record, column));
  if (!value || !(std::abs(*value) <= largest_number))
    throw complaint(record, column, "is not a number; write a finite one, of at most 1e300");
  return *value;
}

std::optional<double> CsvTable::optional_number(std::size_t record, std::size_t column) const {
  if (text(record, column).empty()) return std::nullopt;
  return number(record, column);
}

std::uint64_t CsvTable::count(std::size_t record, std::size_t column) const {
  constexpr std::uint64_t largest = std::uint64_t{1} << 53;
  const auto value = number_in<std::uint64_t>(text(record, column));
  if (!value || *value > largest) throw complaint(record, column, "is not a whole number from 0 to 2^53");
  return *value;
}

bool CsvTable::truth(std::size_t record, std::size_t column) const {
  const std::string& field = text(record, column);
  if (field != "true" && field != "false") throw complaint(record, column, "is neither true nor false");
  return field == "true";
}

}  // namespace mssim
