#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// The stencil of a panel's nodes: the springs of grid_stencil, each from the node with the lower number, as
/// whoever walks over rows of nodes needs them, and in the order in which elongations are corrected
/// (correction_order): structural, shear and bending, of each kind along a row before between rows.
inline constexpr auto panel_stencil = [] {
  auto stencil = grid_stencil;
  for (GridSpring& spring : stencil)
    if (spring.rows < 0) spring = {-spring.rows, -spring.columns, spring.kind};
  std::ranges::sort(stencil, [](const GridSpring& a, const GridSpring& b) {
    if (a.kind != b.kind) return a.kind < b.kind;
    return a.rows != b.rows ? a.rows < b.rows : a.columns > b.columns;
  });
  return stencil;
}();

/// The first so many are limited in their elongation: bending springs, two cells long, may change length by
/// bending.
inline constexpr auto limited_directions = static_cast<std::size_t>(
    std::ranges::count_if(panel_stencil, [](const GridSpring& spring) { return spring.kind != bending; }));

/// The springs whose elongation is limited, structural and shear, as numbers into System::springs, in the
/// order in which velocities are corrected: within each block along the rows, along the columns and along
/// the two kinds of diagonals, then in the same order of directions what joins a block to the next. Springs
/// of one line follow each other, so that a correction travels along it; lines of one direction have no node
/// in common, nor have blocks, so that they may be corrected side by side with the same result. Forwards and
/// backwards by turns this converges several times as fast as an order that colours single springs.
/// Throws std::invalid_argument where the springs are not those of the panels.
std::vector<std::uint32_t> correction_order(const Garment& garment, const std::vector<Spring>& springs);

/// Three arrays of floats, one a component.
struct Float3Arrays {
  AlignedArray x, y, z;

  Float3Arrays() = default;
  explicit Float3Arrays(std::size_t size) : x(size), y(size), z(size) {}

  Vec3<float> at(std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
  void put(std::size_t i, const Vec3<float>& value) {
    x.data()[i] = value.x;
    y.data()[i] = value.y;
    z.data()[i] = value.z;
  }
};

/// A garment's panels as rows of floats, for vectors along the rows. A row is `stride` floats: its nodes,
/// filled up to whole vectors of the widest kind, and one such vector more, so that a vector that begins
/// beside one with nodes ends in the same row. Two empty rows stand before and after each panel: no neighbour
/// of a node lies outside the arrays. What is no node has no inverse mass, and what is no spring no rest
/// length.
struct GarmentGrid {
  struct Panel {
    std::size_t rows, columns, stride;
    std::size_t first;  ///< float of row 0, column 0
    std::array<std::vector<float>, panel_stencil.size()>
        stiffness;         ///< [rows] N/m, of the springs a row owns
    const BodyMaps* body;  ///< as the panel's layer meets it; nullptr: none
  };
  /// Rows of a panel that one thread works on.
  struct Block {
    std::size_t panel, begin, end;
  };
  struct Joint {
    std::size_t node, first, second;  ///< floats
    float fraction;                   ///< of the edge
  };

  /// Throws Unsupported where springs of one row and direction differ in stiffness, and std::invalid_argument
  /// where the springs are not those of the panels.
  explicit GarmentGrid(const System& system);

  void set_state(const State& state);
  State state() const;

  std::vector<Panel> panels;
  std::vector<Block> blocks;
  std::vector<std::size_t> offset;  ///< [nodes] float of a node

  Float3Arrays position;  ///< at the beginning of a step
  Float3Arrays moved;     ///< where contact has moved it to within the step
  Float3Arrays velocity;
  Float3Arrays pull;                                    ///< acceleration by joints, m/s^2
  AlignedArray inverse_mass;                            ///< 1/kg, 0 for pins
  AlignedArray free;                                    ///< the same, 0 for what friction holds, too
  std::array<AlignedArray, panel_stencil.size()> rest;  ///< m
  std::vector<Joint> joints;
  std::vector<std::uint8_t> sewn;  ///< [joints]
  std::vector<std::size_t> held;   ///< floats of the nodes that keep their height while the seams close
};

}  // namespace mssim
