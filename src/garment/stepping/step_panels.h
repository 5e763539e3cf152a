#pragma once

#include <cstddef>
#include <optional>

#include "backends/threads/team_gain.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/garment_grid.h"

namespace mssim {

/// State of a dressing.
struct PanelDressing {
  const System& system;
  const Garment& garment;
  GarmentGrid grid;
  std::size_t threads;
  double dt_s;
  std::optional<ClothClothCollision> layers;  ///< none: layers do not touch
  Seaming seaming = {};
  TeamGain team_gain = {};
};

/// Loop 3: sews the joints whose gap is small enough, and sets the accelerations by the others at their ends.
/// Joints are as few as the rows of a panel, so that one thread suffices.
void pull_joints(PanelDressing& dressing);

/// Runs after loop 5, which would reopen sewn joints: their ends move as one except for closing the gap, and
/// held edges keep their height.
void close_sewn_joints(PanelDressing& dressing);

}  // namespace mssim
