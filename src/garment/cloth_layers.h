#pragma once

#include <cstdint>
#include <vector>

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

/// How layers of cloth keep apart.
struct ClothClothSettings {
  double thickness = 0.003;  ///< m, the distance that layers keep; more than what they approach in a step
  double friction = 0.3;     ///< Coulomb's coefficient, not negative
  /// m/s, not negative: layers that are too near, or have crossed, move apart at most so fast. The move is
  /// one of positions, and leaves no speed behind.
  double push_speed = 1;
  std::uint32_t sweeps =
      2;  ///< over all contacts in a step, at least 1: more follow stacks of contacts farther
};

/// Layers of cloth that collide with each other (garment/layers/cloth_cloth.h).
struct TouchingLayers {
  ClothLayers layers;
  ClothClothSettings settings;
};

}  // namespace mssim
