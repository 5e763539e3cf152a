#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/system.h"

namespace mssim {

/// The triangles that a system shows from outside.
struct NodeSurface {
  std::vector<std::uint32_t> node;                      ///< [points] the node that each is
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points, counter-clockwise seen from outside
  std::vector<std::uint32_t> part;                      ///< [points] index into `parts`
  std::vector<std::string> parts;                       ///< "cloth", "body 1", or the names of panels
};

/// The surface of `nodes` nodes that hang together like `topology`: a cloth, the panels of a garment, two
/// triangles a cell, or the outside of bodies. Nodes ascend; those inside bodies are left out.
NodeSurface surface_of(const Topology& topology, std::size_t nodes);

/// [nodes] which body each belongs to, from 0 on in the order of their first nodes.
std::vector<std::uint32_t> bodies_of(const std::vector<Tetrahedron>& tetrahedra, std::size_t nodes);

}  // namespace mssim
