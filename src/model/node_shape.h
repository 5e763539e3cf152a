#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/system.h"

namespace mssim {

/// The topology of a system's nodes as needed by surfaces, traces, exports and pictures.
struct NodeShape {
  std::string_view kind;                ///< "cloth", "bodies" or "garment": the group of the nodes in a trace
  std::vector<GarmentPanel> sheets;     ///< the cloth or panels, with all nodes in order; none for bodies
  std::vector<Tetrahedron> tetrahedra;  ///< of bodies
  bool in_panels = false;               ///< sheets are a garment's panels, possibly with a body
};

/// The shape of a system's nodes.
NodeShape shape_of(const Topology& topology);

/// Throws std::invalid_argument, with the violated rule of traces, unless there are nodes and they are either
/// those of the sheets, in order, or those of the tetrahedra: an index out of range would crash readers.
void require_fitting_shape(const NodeShape& shape, std::size_t nodes);

/// The visible surface triangles of a system.
struct NodeSurface {
  std::vector<std::uint32_t> node;                      ///< [points] the node of each
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points, counter-clockwise seen from outside
  std::vector<std::uint32_t> part;                      ///< [points] index into `parts`
  std::vector<std::string> parts;                       ///< "cloth", "body 1", or the names of panels
};

/// The surface of `nodes` nodes of that shape: sheets with two triangles per cell, or the outside of bodies.
/// Nodes ascend; those inside bodies are omitted.
NodeSurface surface_of(const NodeShape& shape, std::size_t nodes);

/// [nodes] the body of each, numbered from 0 in the order of their first nodes.
std::vector<std::uint32_t> bodies_of(const std::vector<Tetrahedron>& tetrahedra, std::size_t nodes);

}  // namespace mssim
