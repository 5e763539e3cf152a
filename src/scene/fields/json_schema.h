#pragma once

#include <string>
#include <string_view>

#include "scene/fields/field_visitor.h"

namespace mssim {

/// The JSON Schema (draft 7) of a file whose top object has these fields: it accepts what read_fields
/// accepts. `title` and `description` are of the file. Indented, ends with a newline.
std::string json_schema(std::string_view title, std::string_view description, const FieldList& fields);

}  // namespace mssim
