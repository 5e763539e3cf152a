#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/aligned_array.h"
#include "garment/stepping/panel_stencil.h"
#include "model/system.h"

namespace mssim {

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
};

}  // namespace mssim
