#pragma once

#include <cstdint>
#include <variant>

#include "garment/pattern/garment_build.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

// The fields of a garment scene and their checks. A SceneSpec's content must be a garment.

/// The content of a garment scene.
inline const GarmentSpec& garment_of(const SceneSpec& spec) { return std::get<GarmentSpec>(spec.content); }

/// Largest length of a garment or its body, m.
inline constexpr double largest_length_m = 10;

/// Largest number of nodes of jeans, and of all pieces.
inline constexpr std::uint32_t most_garment_nodes = 10'000'000;

/// Names the field of a length of a garment or its body.
inline void visit_length(FieldVisitor& fields, const Field& field, double& target) {
  fields.number(field, target, above(0, largest_length_m));
}

/// Names the fields of the body, with their targets in garment.body.
void visit_body_fields(FieldVisitor& fields, GarmentSpec& garment);

/// Checks that a body from a file looks along a horizontal axis. Throws SceneError.
void check_body(const SceneSpec& spec);

/// Names the fields of a panel's cloth.
void visit_cloth(FieldVisitor& fields, PanelMaterial& cloth);

/// Names the fields of pieces.
void visit_pieces(FieldVisitor& fields, PiecesSpec& pieces);

/// Throws SceneError, which names the place, for a panel without a name, for invalid boundary curves, and for
/// more than most_garment_nodes nodes. build_garment refuses errors that appear only in cutting and sewing.
void check_pieces(const SceneSpec& spec);

/// Appends the garment's pieces, if any, which check_pieces accepts, to a pattern.
void append_pieces(const GarmentSpec& garment, GarmentPattern& pattern);

}  // namespace mssim
