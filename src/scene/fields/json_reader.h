#pragma once

#include <filesystem>
#include <string>

#include "scene/fields/field_visitor.h"

namespace mssim {

/// Gives every value of a JSON text's top object to its field, recursively. `file` is where the text came
/// from. Throws SceneError, one sentence with file, JSON pointer, value and remedy, for what is not strict
/// JSON (parse_json), a document that is no object, an unknown key (naming the nearest known one), a missing
/// key, a wrong type, a fraction where an integer is asked for, and a number out of its range.
void read_fields(const std::filesystem::path& file, const std::string& text, const FieldList& fields);

}  // namespace mssim
