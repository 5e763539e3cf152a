#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garment/cloth_layers.h"
#include "garment/garment.h"
#include "geometry/vec3.h"

namespace mssim {

/// Every two panels of different layers, the one of the lower layer being the inner one, in ascending order.
/// Two panels that a joint sews together are left out: they would repel each other at their seam.
std::vector<PanelPair> layer_pairs(const Garment& garment);

/// The panels whose normals point, summed over their cells, towards the vertical line through `axis` rather
/// than away from it. Meant for the placed panels of a start state; position: [nodes] m.
std::vector<std::uint32_t> mirrored_panels(const Garment& garment, std::span<const Vec3d> position,
                                           const Vec3d& axis);

/// Throws std::invalid_argument, in one sentence, unless all panels that are named exist and have at least
/// 2 x 2 nodes below `nodes`, and no panel is paired with itself, nor two panels twice.
void validate_layers(const ClothLayers& layers, const Garment& garment, std::size_t nodes);

}  // namespace mssim
