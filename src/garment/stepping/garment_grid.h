#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// The stencil of a panel's nodes: the springs of grid_stencil, each from the node with the lower number, for
/// loops over rows of nodes. They are in the order in which elongations are corrected (correction_order):
/// structural, shear and bending, and of each kind those along a row before those between rows.
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

/// Number of leading directions whose elongation is limited. Bending springs, two cells long, may
/// change length by bending.
inline constexpr auto limited_directions = static_cast<std::size_t>(
    std::ranges::count_if(panel_stencil, [](const GridSpring& spring) { return spring.kind != bending; }));

/// The structural and shear springs, whose elongation is limited, as indices into System::springs, in the
/// order in which velocities are corrected. Within each block, this is along the rows, along the columns and
/// along the two kinds of diagonals; then, in the same order of directions, the springs that join a block to
/// the next. Springs of a line are consecutive, so that a correction propagates along it. Lines of one
/// direction have no common node, nor have blocks, so that correcting them in parallel gives the same result.
/// With sweeps that alternate between forwards and backwards, this converges several times as fast as an
/// order that colours single springs. Throws std::invalid_argument if the springs are not those of the
/// panels.
std::vector<std::uint32_t> correction_order(const Garment& garment, const std::vector<Spring>& springs);

/// Three arrays of floats, one per component.
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
/// padded to whole vectors of the widest kind, and one more such vector, so that an unaligned vector ends in
/// the same row. Two empty rows precede and follow each panel: no neighbour of a node lies outside the
/// arrays. Padding has inverse mass 0, and missing springs have rest length 0.
struct GarmentGrid {
  struct Panel {
    std::size_t rows, columns, stride;
    std::size_t first;  ///< index of the float of row 0, column 0
    std::array<std::vector<float>, panel_stencil.size()>
        stiffness;         ///< [rows] N/m, of the springs that a row owns
    const BodyMaps* body;  ///< maps for the panel's layer; nullptr: none
  };
  /// Rows of a panel that one thread handles.
  struct Block {
    std::size_t panel, begin, end;
  };
  struct Joint {
    std::size_t node, first, second;  ///< indices of floats
    float fraction;                   ///< of the edge
  };

  /// Throws Unsupported if springs of one row and direction differ in stiffness, and std::invalid_argument if
  /// the springs are not those of the panels.
  explicit GarmentGrid(const System& system);

  void set_state(const State& state);
  State state() const;

  std::vector<Panel> panels;
  std::vector<Block> blocks;
  std::vector<std::size_t> offset;  ///< [nodes] index of each node's float

  Float3Arrays position;  ///< at the start of a step
  Float3Arrays moved;     ///< position after contact within the step
  Float3Arrays velocity;
  Float3Arrays pull;                                    ///< m/s^2, acceleration by joints
  AlignedArray inverse_mass;                            ///< 1/kg, 0 for pins
  AlignedArray free;                                    ///< inverse_mass, but 0 for nodes that friction holds
  std::array<AlignedArray, panel_stencil.size()> rest;  ///< m
  std::vector<Joint> joints;
  std::vector<std::size_t> held;  ///< nodes that keep their height while the seams close, by float
};

}  // namespace mssim
