#include "output/tables/listing.h"

#include <algorithm>
#include <sstream>

#include "output/tables/csv.h"

namespace mssim {
namespace {

/// A value for a terminal.
std::string cell(const nlohmann::ordered_json& value, int digits) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_number_float()) return value.dump();
  std::ostringstream text;
  text.precision(digits);
  text << value.get<double>();
  return text.str();
}

/// How many characters a terminal shows of UTF-8.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }));
}

std::string aligned(const Listing& listing, int digits) {
  std::vector<std::vector<std::string>> lines{{}};
  std::vector<bool> numeric;
  for (const auto& [key, value] : listing.front().items()) {
    lines.front().push_back(key);
    numeric.push_back(true);
  }
  for (const auto& row : listing) {
    std::vector<std::string> line;
    for (const auto& [key, value] : row.items()) {
      if (!value.is_number() && !value.is_null()) numeric[line.size()] = false;
      line.push_back(cell(value, digits));
    }
    lines.push_back(std::move(line));
  }
  std::vector<std::size_t> width(numeric.size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) width[i] = std::max(width[i], width_of(line[i]));
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string padding(width[i] - width_of(line[i]), ' ');
      if (i > 0) row += "  ";
      row += numeric[i] ? padding + line[i] : line[i] + padding;
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + '\n';
  }
  return text;
}

std::string as_csv(const Listing& listing) {
  std::vector<std::string> header;
  for (const auto& [key, value] : listing.front().items()) header.push_back(key);
  std::string text = csv_line(header);
  for (const auto& row : listing) {
    std::vector<std::string> line;
    for (const auto& [key, value] : row.items())
      line.push_back(value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump());
    text += csv_line(line);
  }
  return text;
}

}  // namespace

std::string to_text(const Listing& listing, ListingFormat format, int digits) {
  if (format == ListingFormat::json)
    return nlohmann::ordered_json(listing).dump(2, ' ', false,
                                                nlohmann::ordered_json::error_handler_t::replace) +
           '\n';
  if (listing.empty()) return "";
  return format == ListingFormat::csv ? as_csv(listing) : aligned(listing, digits);
}

}  // namespace mssim
