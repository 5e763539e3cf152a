#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "garment/contact/body_maps.h"
#include "geometry/vec3.h"

namespace mssim {

/// The correction of over-elongated springs (Vassilev's loop 5).
enum class VelocityCorrection : std::uint8_t {
  none,
  /// As published: the part of its ends' velocities that lengthens such a spring is removed.
  published,
  /// Such a spring must also shorten: its ends approach at rate * excess / dt or faster.
  bounded
};

/// Parameters of a dressing step that are not properties of the cloth. The step is Vassilev's Algorithm 1;
/// ARCHITECTURE.md lists what mssim adds to the published one.
struct DressingSettings {
  /// While the seams close, there is no friction and, by default, no gravity: the panels would fall before
  /// the seams hold them.
  double seam_force = 4;               ///< N per metre of seam, initially
  double seam_force_doubling_s = 0.5;  ///< time in which the force grows by its initial value
  double seaming_damping = 8;          ///< 1/s, per mass; draping uses System::viscous_damping
  double seaming_gravity = 0;          ///< fraction of gravity that acts while the seams close
  double longest_seaming_s = 1;        ///< seams that are open then are sewn as they are
  /// While the seams close, the upper edge of every panel keeps its height, as if hands held the waistband.
  bool edge_held = false;
  /// A joint with a smaller gap is sewn: from then on, an inelastic constraint on velocities closes its gap.
  double sewn_gap = 0.01;      ///< m
  double closing_share = 0.2;  ///< largest fraction of a sewn joint's gap that a step closes
  double closing_speed = 0.5;  ///< m/s, the largest
  double friction = 0.5;       ///< Coulomb's coefficient on the body, while draping
  double push_speed = 1;       ///< m/s, the largest at which a point inside the body is moved out

  VelocityCorrection correction = VelocityCorrection::bounded;
  double correction_threshold = 0.05;   ///< elongation over rest length
  double correction_rate = 0.5;         ///< see VelocityCorrection::bounded
  std::uint32_t correction_sweeps = 2;  ///< over all springs, alternately forwards and backwards
};

/// Settings of collisions between layers of cloth (garment/layers/cloth_cloth.h).
struct ClothClothSettings {
  double thickness = 0.003;  ///< m, distance that layers keep; more than they approach per step
  double friction = 0.3;     ///< Coulomb's coefficient, not negative
  /// m/s, not negative: largest speed at which layers that are too near, or have crossed, are moved apart.
  /// Only positions change, not velocities.
  double push_speed = 1;
  std::uint32_t sweeps =
      2;  ///< over all contacts per step, at least 1; more propagate farther through stacks of contacts
};

/// A pattern piece as a grid of rows x columns nodes, row-major, joined by the 12-neighbour stencil
/// (grid_stencil). In the drawn pattern, row 0 is its lower edge and column 0 its left edge. It is drawn as
/// seen from outside: (direction of the columns) x (direction of the rows) points away from the body.
struct GarmentPanel {
  std::string name;
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  std::uint32_t first_node = 0;  ///< of rows * columns consecutive nodes
  /// Panels of different layers may touch each other; 0 is the innermost.
  std::uint32_t layer = 0;

  std::uint32_t nodes() const { return rows * columns; }
  std::uint32_t node(std::uint32_t row, std::uint32_t column) const {
    return first_node + row * columns + column;
  }
  std::uint32_t row_of(std::uint32_t node) const { return (node - first_node) / columns; }
  std::uint32_t column_of(std::uint32_t node) const { return (node - first_node) % columns; }
  /// The nodes of one of the two triangles of a cell: for half 0, (low left, low right, high right), and for
  /// half 1, (low left, high right, high left).
  std::array<std::uint32_t, 3> triangle(std::uint32_t row, std::uint32_t column, std::uint32_t half) const {
    const std::uint32_t low_left = node(row, column), high_right = low_left + columns + 1;
    if (half == 0) return {low_left, low_left + 1, high_right};
    return {low_left, high_right, high_right - 1};
  }
};

/// An element of a seam: a node, and the point of another panel's boundary to which it is sewn. That point is
/// a node or lies on the edge between two nodes (Vassilev, "Cloth simulation").
struct Joint {
  std::uint32_t node = 0;
  std::uint32_t edge_first = 0;
  std::uint32_t edge_second = 0;  ///< equal to edge_first if the point is a node
  double edge_share = 0;          ///< position on the edge, from 0 (first) to 1 (second); 0 for a node
  double length = 0;              ///< m, of the seam that the joint represents
  double strength = 1;            ///< factor of the seam's force
  std::uint32_t seam = 0;         ///< index into Garment::seams
};

/// Nodes whose distance from the body is part of the fit if they hang between two heights.
struct CloseCloth {
  std::vector<std::uint32_t> nodes;
  double lowest = 0, highest = 0;  ///< m, y, inclusive
};

/// A garment: its panels as ranges of nodes, the joints between them, and the settings of its dressing.
struct Garment {
  std::vector<GarmentPanel> panels;
  std::vector<std::string> seams;  ///< names
  std::vector<Joint> joints;
  std::vector<Vec3d> flat;  ///< [nodes] m, z = 0: positions in the pattern; y is the height when worn
  DressingSettings dressing;
  /// [layers] Maps of the body that the panels of each layer collide with; layers beyond the last use the
  /// last. Empty: there is no body.
  std::vector<std::shared_ptr<const BodyMaps>> body_maps;
  CloseCloth close;                            ///< to the body; no nodes: the fit measures no such distance
  std::vector<std::uint32_t> crotch;           ///< nodes at the crotch of jeans; none without jeans
  std::optional<ClothClothSettings> touching;  ///< none: layers pass through each other

  /// The panel that a node belongs to.
  const GarmentPanel& panel_of(std::uint32_t node) const {
    return *(std::ranges::upper_bound(panels, node, {}, &GarmentPanel::first_node) - 1);
  }
  /// Maps of the body for a panel, or nullptr if there are none.
  const BodyMaps* body_met_by(const GarmentPanel& panel) const {
    if (body_maps.empty()) return nullptr;
    return body_maps[std::min<std::size_t>(panel.layer, body_maps.size() - 1)].get();
  }
};

}  // namespace mssim
