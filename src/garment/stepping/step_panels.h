#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "backends/threads/team_gain.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/garment_grid.h"

namespace mssim {

/// A dressing under way.
struct PanelDressing {
  const System& system;
  const Garment& garment;
  GarmentGrid grid;
  std::size_t threads;
  double dt_s;
  std::optional<ClothClothCollision> layers;  ///< that touch
  std::int64_t steps = 0;
  DressingProgress progress = {};
  TeamGain team_gain = {};
};

/// Loop 3: sews the joints that are near enough, and sets what the others do to the nodes at their ends.
/// There are as many as a panel has rows, so that one thread does it.
void pull_joints(PanelDressing& dressing);

/// After loop 5, which would open them again: the ends of a sewn joint move as one but for what closes its
/// gap, and edges that are held keep their height.
void close_sewn_joints(PanelDressing& dressing);

}  // namespace mssim
