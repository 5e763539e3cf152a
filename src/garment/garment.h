#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "garment/cloth_layers.h"
#include "garment/contact/body_maps.h"
#include "garment/dressing.h"
#include "geometry/vec3.h"

namespace mssim {

/// A pattern piece as a grid: rows x columns nodes, row-major, row 0 at its lower edge, column 0 at its left
/// one as the pattern is drawn, joined by the 12-neighbour stencil (grid_stencil).
struct GarmentPanel {
  std::string name;
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  std::uint32_t first_node = 0;  ///< of its rows * columns consecutive ones
  /// Panels of different layers may touch each other; 0 is the innermost.
  std::uint32_t layer = 0;

  std::uint32_t nodes() const { return rows * columns; }
  std::uint32_t node(std::uint32_t row, std::uint32_t column) const {
    return first_node + row * columns + column;
  }
};

/// What a seam is made of: a node and the point of another panel's boundary that it is sewn to, either a node
/// or a point on the edge between two (Vassilev, "Cloth simulation").
struct Joint {
  std::uint32_t node = 0;
  std::uint32_t edge_first = 0;
  std::uint32_t edge_second = 0;  ///< the same as edge_first where it is a node
  double edge_share = 0;          ///< of the way from first to second, 0 to 1; 0 where it is a node
  double length = 0;              ///< m, the share of the seam that it stands for
  double strength = 1;            ///< factor of the seam's force
  std::uint32_t seam = 0;         ///< index into Garment::seams
};

/// Nodes whose distance from the body belongs to the fit, where they hang between two heights.
struct CloseCloth {
  std::vector<std::uint32_t> nodes;
  double lowest = 0, highest = 0;  ///< m, y, both included
};

/// A garment: how its panels lie in the list of nodes, what joins them, and how it is dressed.
struct Garment {
  std::vector<GarmentPanel> panels;
  std::vector<std::string> seams;  ///< names
  std::vector<Joint> joints;
  std::vector<Vec3d> flat;  ///< [nodes] m, z = 0: in the pattern, where y is the height at which it is worn
  DressingSettings dressing;
  /// [layers] The body as the panels of each layer meet it; layers beyond the last one meet it as that does.
  /// Empty: nothing to dress.
  std::vector<std::shared_ptr<const BodyMaps>> body_maps;
  CloseCloth close;                        ///< to the body; no nodes: anywhere else it may hang as it likes
  std::optional<TouchingLayers> touching;  ///< none: layers go through each other

  /// The panel that a node belongs to.
  const GarmentPanel& panel_of(std::uint32_t node) const {
    return *(std::ranges::upper_bound(panels, node, {}, &GarmentPanel::first_node) - 1);
  }
  /// The body as a panel meets it, or nullptr where there is none.
  const BodyMaps* body_met_by(const GarmentPanel& panel) const {
    if (body_maps.empty()) return nullptr;
    return body_maps[std::min<std::size_t>(panel.layer, body_maps.size() - 1)].get();
  }
};

}  // namespace mssim
