#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "garment/garment.h"
#include "geometry/geometry.h"
#include "geometry/vec3.h"

namespace mssim {

/// The coordinates of all nodes: x, y, z, each [nodes] m.
using Coordinates = std::array<std::span<const float>, 3>;

inline Vec3<float> point_of(const Coordinates& position, std::uint32_t node) {
  return {position[0][node], position[1][node], position[2][node]};
}

/// Boxes around the cells of a panel and around its sub-patches: the panel is cut in four, by halves of its
/// rows and columns of cells, and so on. What is cut where stays; the boxes are refitted to each step's
/// positions from the smallest up (Vassilev, "Cloth-cloth collision detection", after Provot 1997).
class PanelBoxes {
 public:
  /// A sub-patch: cells, as row and column numbers of their lower left nodes.
  struct Block {
    std::uint32_t row_begin, row_end, column_begin, column_end;
    std::uint32_t first_child = 0, children = 0;  ///< of blocks(); a leaf has none

    std::uint32_t cells() const { return (row_end - row_begin) * (column_end - column_begin); }
  };
  /// Most cells along each side of a leaf.
  static constexpr std::uint32_t leaf_side = 4;

  /// A panel of at least 2 x 2 nodes.
  explicit PanelBoxes(const GarmentPanel& panel);

  const GarmentPanel& panel() const { return panel_; }
  /// [blocks] children behind their parents; the first is the whole panel.
  const std::vector<Block>& blocks() const { return blocks_; }
  /// [leaves] numbers of the blocks without children.
  const std::vector<std::uint32_t>& leaves() const { return leaves_; }
  const Box<float>& box(std::uint32_t block) const { return boxes_[block]; }
  const Box<float>& cell_box(std::uint32_t row, std::uint32_t column) const {
    return cell_boxes_[row * (panel_.columns - 1) + column];
  }

  /// First for every leaf, in any order, also at the same time: the boxes of a leaf and of its cells.
  void refit_leaf(std::uint32_t leaf, const Coordinates& position);
  /// Then: the boxes of all other blocks.
  void refit_rest();

 private:
  void split(std::uint32_t block);

  GarmentPanel panel_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> leaves_;
  std::vector<Box<float>> boxes_;       // [blocks]
  std::vector<Box<float>> cell_boxes_;  // [rows - 1][columns - 1]
};

}  // namespace mssim
