#pragma once

#include "geometry/surface.h"
#include "tests/support/garment_system.h"

namespace mssim {

/// A panel of 3 x 4 and one of 2 x 5 nodes, sewn to the middle of an edge and to a node.
inline System two_panels() {
  System system = garment_of({{3, 4, 0.01, {0, 0, 0}}, {2, 5, 0.01, {0.1, 0, 0}}});
  Garment& garment = garment_in(system);
  garment.panels[0].name = "front \"left\" & more";
  garment.panels[1].name = "back";
  garment.panels[1].layer = 3;
  garment.seams = {"side", "hem"};
  garment.joints = {{11, 12, 13, 0.25, 0.01, 1, 1}, {3, 17, 17, 0, 0.01, 1, 0}};
  return system;
}

inline Surface small_tetrahedron() {
  return {{{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

}  // namespace mssim
