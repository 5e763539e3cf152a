#pragma once

#include <functional>
#include <string>
#include <vector>

#include "garment/pattern/panel_mesh.h"

namespace mssim {

/// How deep the body is at a height y: z of its foremost and hindmost point, m. The functions answer for
/// every height that a panel reaches.
struct BodyDepth {
  std::function<double(double)> front, back;
};

/// Where a panel begins: before or behind the body, bent round an upright cylinder. A panel keeps the heights
/// that it was drawn at.
struct PanelPlacement {
  bool behind = false;
  /// m, x at which the pattern's x = 0 stands, by height; its sign says on which side of the body
  std::function<double(double)> axis = [](double) { return 0.0; };
  double distance = 0.03;  ///< m, from the body's foremost (hindmost) point at that height
  double radius = 0.105;   ///< m, of the bend
};

/// The nodes of a panel in space, m, rounded to micrometres. Its outside looks away from the body. The half
/// that looks to the plane x = 0 bends by no more than two thirds of the distance and runs straight on from
/// there, so that it stays before everything that the body has at its height: trunk and other leg are there.
/// Throws InputError, which begins with `panel`, where the body has no finite depth and for a distance or
/// radius that is not positive.
std::vector<Vec3d> place_panel(const std::string& panel, const PanelMesh& mesh,
                               const PanelPlacement& placement, const BodyDepth& body);

}  // namespace mssim
