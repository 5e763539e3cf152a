#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "model/system.h"

namespace mssim {

/// The triangles of a system that a picture shows: a cloth, the panels of a garment, or the surface of
/// bodies.
struct Skin {
  std::vector<std::uint32_t> node;  ///< [points] the node that each shows; at a crease several show one
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points, counter-clockwise seen from outside
  std::vector<std::uint32_t> part;                      ///< [points] index into `parts`
  std::vector<std::string> parts;                       ///< "cloth", "body 1", or the names of panels
};

/// The skin of nodes that hang together like `topology` and rest at `start`. Points are divided where a
/// surface of bodies bends by more than 40 degrees there, so that edges are drawn sharp.
Skin skin_of(const Topology& topology, const std::vector<Vec3d>& start);

}  // namespace mssim
