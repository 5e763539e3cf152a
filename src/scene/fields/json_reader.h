#pragma once

#include "scene/fields/field_visitor.h"
#include "scene/fields/json_document.h"

namespace mssim {

/// Gives every value of the document's top object to its field, recursively. Throws SceneError, one sentence
/// with file, JSON pointer, value and remedy, for a document that is no object, an unknown key (naming the
/// nearest known one), a missing key, a wrong type, a fraction where an integer is asked for, and a number
/// out of its range.
void read_fields(const JsonDocument& document, const FieldList& fields);

}  // namespace mssim
