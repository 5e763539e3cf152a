#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mssim {

/// Rows of named values for people and programs: each row is a JSON object with the same keys in the same
/// order; null stands for a value that does not exist.
using Listing = std::vector<nlohmann::ordered_json>;

enum class ListingFormat { table, csv, json };

/// Columns aligned for a terminal (numbers to the right, at most `digits` significant), RFC 4180 CSV with a
/// header, or a JSON array. Ends with a newline.
std::string to_text(const Listing& listing, ListingFormat format, int digits = 4);

}  // namespace mssim
