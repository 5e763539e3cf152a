#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "garment/garment.h"
#include "geometry/geometry.h"
#include "geometry/vec3.h"

namespace mssim {

/// Two panels of a garment that may touch each other: `inner` lies between the body and `outer`.
struct PanelPair {
  std::uint32_t inner = 0;  ///< index into Garment::panels
  std::uint32_t outer = 0;

  bool operator==(const PanelPair&) const = default;
};

/// All pairs of panels of different layers, in ascending order; `inner` is of the lower layer.
std::vector<PanelPair> layer_pairs(const Garment& garment);

/// The coordinates of all nodes: x, y, z, each [nodes] m.
using Coordinates = std::array<std::span<const float>, 3>;

/// The position of a node, m.
inline Vec3<float> point_of(const Coordinates& position, std::uint32_t node) {
  return {position[0][node], position[1][node], position[2][node]};
}

/// A tree of boxes around the cells of a panel and its sub-patches: the panel is cut in four, by halving its
/// rows and columns of cells, and so on. The tree does not change; its boxes are refitted bottom up to the
/// positions of each step (Vassilev, "Cloth-cloth collision detection", after Provot 1997).
class PanelBoxes {
 public:
  /// A sub-patch: a range of cells, by row and column of their lower left nodes.
  struct Block {
    std::uint32_t row_begin, row_end, column_begin, column_end;
    std::uint32_t first_child = 0, children = 0;  ///< of blocks(); a leaf has none

    std::uint32_t cells() const { return (row_end - row_begin) * (column_end - column_begin); }
  };
  /// Largest number of cells along a side of a leaf.
  static constexpr std::uint32_t leaf_side = 4;

  /// `panel` has at least 2 x 2 nodes.
  explicit PanelBoxes(const GarmentPanel& panel);

  const GarmentPanel& panel() const { return panel_; }
  /// [blocks] children after their parents; the first is the whole panel.
  const std::vector<Block>& blocks() const { return blocks_; }
  /// [leaves] numbers of the blocks without children.
  const std::vector<std::uint32_t>& leaves() const { return leaves_; }
  const Box<float>& box(std::uint32_t block) const { return boxes_[block]; }
  const Box<float>& cell_box(std::uint32_t row, std::uint32_t column) const {
    return cell_boxes_[row * (panel_.columns - 1) + column];
  }

  /// Refits the boxes of a leaf and of its cells. First step, for every leaf, in any order or in parallel.
  void refit_leaf(std::uint32_t leaf, const Coordinates& position);
  /// Refits the boxes of all other blocks. Second step.
  void refit_rest();

 private:
  void split(std::uint32_t block);

  GarmentPanel panel_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> leaves_;
  std::vector<Box<float>> boxes_;       // [blocks]
  std::vector<Box<float>> cell_boxes_;  // [rows - 1][columns - 1]
};

/// A node of one panel near a triangle of another.
struct ClothContact {
  std::uint32_t node = 0;
  std::array<std::uint32_t, 3> triangle{};  ///< nodes
  std::array<float, 3> weight{};            ///< barycentric, of the triangle's point nearest to the node
  Vec3<float> normal{};                     ///< unit, from the triangle to the node's correct side
  float gap = 0;  ///< m, from the triangle along the normal; negative on the wrong side

  bool operator==(const ClothContact&) const = default;
};

/// Finds contacts between panels: for each node of either panel of a pair, the nearest triangle of the other
/// panel. Edges are not tested against edges: cells must be fine enough that two edges do not cross while all
/// nodes keep their distance.
///
/// Nodes of the outer panel belong on the side of the inner panel to which its normal points (GarmentPanel),
/// nodes of the inner panel on the opposite side of the outer one. The triangle's normal decides the side if
/// the nearest point is inside the triangle. If it is on an edge or corner, the normals at the nodes decide,
/// so that a fold does not swap sides. A node beyond the border of a panel (its nearest point is on the
/// border) is a contact only on the correct side: the panel cannot tell on which side such a node belongs,
/// but its rim can still touch it.
class ClothContactSearch {
 public:
  /// Searches the pairs of layer_pairs on `threads` threads, at least one. Nodes nearer to a triangle than
  /// `reach` (m, positive) are contacts.
  ClothContactSearch(const Garment& garment, double reach, int threads);

  /// The contacts at these positions, pair by pair, first those of the outer panel's nodes, in ascending
  /// order of nodes; bitwise identical for every number of threads. Valid until the next call. Positions that
  /// are not finite have no contacts.
  std::span<const ClothContact> find(const Coordinates& position);

 private:
  struct Pair {
    std::uint32_t inner, outer;  // indices into boxes_
    std::uint32_t first_slot;    // one for each outer node, then one for each inner node
  };
  struct Leaf {
    std::uint32_t boxes, block;
  };
  struct Nearest {  // triangle to a slot's node
    float distance_squared;
    std::uint32_t triangle;  // 2 * cell + half

    auto operator<=>(const Nearest&) const = default;  // NOLINT(modernize-use-nullptr)
  };
  struct Candidate {
    std::uint32_t slot;
    Nearest nearest;
  };
  using Candidates = std::vector<Candidate>;

  std::uint32_t boxes_of(const GarmentPanel& panel);
  void search(const Pair& pair, std::uint32_t inner_block, std::uint32_t outer_block,
              const Coordinates& position);
  void test_nodes(const PanelBoxes& of_nodes, std::uint32_t node_block, const PanelBoxes& of_triangles,
                  std::uint32_t triangle_block, std::uint32_t first_slot, const Coordinates& position,
                  Candidates& found) const;
  void keep_nearest();
  void make_contacts(const Coordinates& position);

  const float reach_;
  const int threads_;
  std::vector<PanelBoxes> boxes_;  // of the panels in pairs
  std::vector<Leaf> leaves_;       // of all boxes
  std::vector<Pair> pairs_;        // [pairs]
  std::vector<Nearest> slots_;     // [slots] the nearest triangle of each node of each pair
  std::vector<Candidates> found_;  // [threads]
  std::vector<ClothContact> contacts_;
};

/// The number of crossings of two panels: pairs of an edge of one panel (sides of cells, and diagonals from
/// low left to high right) and a triangle of the other through which it runs. 0 if the panels are apart,
/// however near, and also if one is entirely on its wrong side. Edges and triangles with a node of `sewn` do
/// not count.
///
/// Signs of volumes decide, in double precision and without a tolerance. The signs at a side that two
/// triangles share are equal for both, so that an edge through that side crosses exactly one of them. For
/// checks, not for every step. position: [nodes] m, finite.
std::size_t count_crossings(const GarmentPanel& first, const GarmentPanel& second,
                            std::span<const Vec3d> position, const std::set<std::uint32_t>& sewn = {});

/// The sum over all pairs of layers (layer_pairs). Of panels that are sewn to each other, what ends at their
/// seam does not count.
std::size_t count_crossings(const Garment& garment, std::span<const Vec3d> position);

}  // namespace mssim
