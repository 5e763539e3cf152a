#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "output/tables/table.h"

namespace mssim {

/// An array of an object a row, whose keys are the columns; nothing is null.
nlohmann::ordered_json table_json(const Table& table);
/// The table's JSON as text.
std::string table_json_text(const Table& table);

/// A text as JSON spells it, in quotes. Bytes that are no UTF-8 are replaced.
std::string json_string(const std::string& text);

/// A real as JSON spells it: with a point or an exponent.
std::string json_number(double number);

/// JSON as mssim writes it: indented by two, with a line feed at the end. Bytes that are no UTF-8 (a file's
/// name may hold any) are replaced.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace mssim
