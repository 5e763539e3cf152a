#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/garment.h"
#include "model/vec3.h"

namespace mssim {

/// Two panels of a garment that may touch each other: `inner` lies between the body and `outer`.
struct PanelPair {
  std::uint32_t inner = 0;  ///< index into Garment::panels
  std::uint32_t outer = 0;

  bool operator==(const PanelPair&) const = default;
};

/// Which panels may touch each other, and which way they face.
///
/// A panel's right side is where its nodes are seen as the pattern is drawn, columns to the right and rows
/// upwards: its normal is (direction of the columns) x (direction of the rows), and it points away from the
/// body, unless the panel is listed as mirrored, like the left half of a pattern that is drawn for the right.
struct ClothLayers {
  std::vector<PanelPair> pairs;
  std::vector<std::uint32_t> mirrored;  ///< panels whose normal points towards the body
};

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
