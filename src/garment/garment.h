#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "garment/contact/body_maps.h"
#include "geometry/vec3.h"

namespace mssim {

/// How over-elongated springs are kept from growing (Vassilev's loop 5).
enum class VelocityCorrection : std::uint8_t {
  none,
  /// As published: what lengthens such a spring is taken from the velocities of its ends.
  published,
  /// Such a spring has to shorten, too: its ends may part at -rate * excess / dt at most.
  bounded
};

/// What dressing takes beside springs: everything about one step that is no property of the cloth. The step
/// is Vassilev's Algorithm 1; ARCHITECTURE.md says where it goes beyond what was published.
struct DressingSettings {
  /// While the seams close there is no friction and, by default, no gravity: the panels would fall before
  /// they hold.
  double seam_force = 4;               ///< N per metre of seam at first
  double seam_force_doubling_s = 0.5;  ///< the force grows by its first value in this time
  double seaming_damping = 8;          ///< 1/s, per mass; draping takes System::viscous_damping
  double seaming_gravity = 0;          ///< share of gravity that acts meanwhile
  double longest_seaming_s = 1;        ///< what is open then is sewn as it is
  /// Meanwhile the upper edge of every panel keeps its height, as hands hold the waistband of trousers.
  bool edge_held = false;
  /// A joint nearer than this is sewn: from then on its gap closes by an inelastic constraint on velocities.
  double sewn_gap = 0.01;      ///< m
  double closing_share = 0.2;  ///< of a sewn joint's gap that a step closes at most
  double closing_speed = 0.5;  ///< m/s, at most
  double friction = 0.5;       ///< Coulomb's coefficient on the body, while draping
  double push_speed = 1;       ///< m/s at which a point inside the body is moved out, at most

  VelocityCorrection correction = VelocityCorrection::bounded;
  double correction_threshold = 0.05;   ///< elongation over rest length
  double correction_rate = 0.5;         ///< see VelocityCorrection::bounded
  std::uint32_t correction_sweeps = 2;  ///< over all springs, forwards and backwards by turns
};

/// How layers of cloth keep apart (garment/layers/cloth_cloth.h).
struct ClothClothSettings {
  double thickness = 0.003;  ///< m, the distance that layers keep; more than what they approach in a step
  double friction = 0.3;     ///< Coulomb's coefficient, not negative
  /// m/s, not negative: layers that are too near, or have crossed, move apart at most so fast. The move is
  /// one of positions, and leaves no speed behind.
  double push_speed = 1;
  std::uint32_t sweeps =
      2;  ///< over all contacts in a step, at least 1: more follow stacks of contacts farther
};

/// A pattern piece as a grid: rows x columns nodes, row-major, row 0 at its lower edge, column 0 at its left
/// one as the pattern is drawn, joined by the 12-neighbour stencil (grid_stencil). It is drawn as it is seen
/// from outside: (direction of the columns) x (direction of the rows) points away from the body.
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
  CloseCloth close;  ///< to the body; no nodes: anywhere else it may hang as it likes
  std::optional<ClothClothSettings> touching;  ///< none: layers go through each other

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
