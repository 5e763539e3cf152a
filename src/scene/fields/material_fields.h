#pragma once

#include "model/spring.h"
#include "scene/fields/field_visitor.h"

namespace mssim {

inline constexpr double largest_stiffness = 1e9;  ///< N/m

/// Names the fields of one kind of spring, with their targets in `material`.
inline void visit_material(FieldVisitor& fields, SpringMaterial& material, const Range& stiffness) {
  fields.number({"stiffness_n_per_m", "Force per lengthening, N/m."}, material.stiffness, stiffness);
  fields.number({"damping_n_s_per_m", "Force against the rate of lengthening, along the spring, N s/m."},
                material.damping, from(0, 1e6));
}

}  // namespace mssim
