#pragma once

#include <cstddef>
#include <vector>

#include "garment/cloth_layers.h"
#include "garment/garment.h"

namespace mssim {

/// Every two panels of different layers, the one of the lower layer being the inner one, in ascending order.
/// Two panels that a joint sews together are left out: they would repel each other at their seam.
std::vector<PanelPair> layer_pairs(const Garment& garment);

/// Throws std::invalid_argument, in one sentence, unless all panels that are named exist and have at least
/// 2 x 2 nodes below `nodes`, and no panel is paired with itself, nor two panels twice.
void validate_layers(const ClothLayers& layers, const Garment& garment, std::size_t nodes);

}  // namespace mssim
