#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/system.h"

namespace mssim {

/// What lies between the nodes of a system: all that surfaces, traces, exports and pictures ask of a
/// topology.
struct NodeShape {
  std::string_view kind;                ///< "cloth", "bodies" or "garment": the group of the nodes in a trace
  std::vector<GarmentPanel> sheets;     ///< all nodes in their order, the cloth or panels; none for bodies
  std::vector<Tetrahedron> tetrahedra;  ///< of bodies
  bool in_panels = false;               ///< sheets are a garment's panels, and a body may stand beside them
};

NodeShape shape_of(const Topology& topology);

/// Throws std::invalid_argument, with the rule of traces that is broken, unless there are nodes, and they are
/// either those of the sheets, one behind the other, or those that tetrahedra join: what points beyond its
/// nodes would crash who reads it.
void require_fitting_shape(const NodeShape& shape, std::size_t nodes);

/// The triangles that a system shows from outside.
struct NodeSurface {
  std::vector<std::uint32_t> node;                      ///< [points] the node that each is
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points, counter-clockwise seen from outside
  std::vector<std::uint32_t> part;                      ///< [points] index into `parts`
  std::vector<std::string> parts;                       ///< "cloth", "body 1", or the names of panels
};

/// The surface of `nodes` nodes of that shape: sheets, two triangles a cell, or the outside of bodies. Nodes
/// ascend; those inside bodies are left out.
NodeSurface surface_of(const NodeShape& shape, std::size_t nodes);

/// [nodes] which body each belongs to, from 0 on in the order of their first nodes.
std::vector<std::uint32_t> bodies_of(const std::vector<Tetrahedron>& tetrahedra, std::size_t nodes);

}  // namespace mssim
