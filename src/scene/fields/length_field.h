#pragma once

#include "scene/fields/field_visitor.h"

namespace mssim {

/// No length of a garment or its body is larger, m.
inline constexpr double largest_length_m = 10;

/// A length of a garment or its body.
inline void visit_length(FieldVisitor& fields, const Field& field, double& target) {
  fields.number(field, target, above(0, largest_length_m));
}

}  // namespace mssim
