#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "backends/implicit/constraints/compliance.h"
#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/threads/team_gain.h"
#include "model/system.h"

namespace mssim {

/// Where the nodes of a cloth lie: the columns of a row in four streams, by the column's number modulo four,
///
///     [row][column % 4][x y z u v w][column / 4]      (u v w: velocity).
///
/// The springs of a colour (ClothColour) that begin in one stream all end in one stream, of the same row or
/// of another: a vector of the one and a vector of the other, beginning at the same place or one node
/// further, are the ends of as many springs. So there is nothing to shuffle or to gather. Each component
/// begins a vector.
struct QuarterLayout {
  static constexpr std::size_t streams = 4, components = 6;

  std::size_t lanes, rows, columns;
  std::size_t pitch;  ///< floats from one component of a stream to the next, an odd number of vectors

  QuarterLayout(const GridPatch& grid, std::size_t lane_count);

  std::size_t row_floats() const { return streams * components * pitch; }
  std::size_t rest_row_floats() const { return streams * 3 * pitch; }
  /// Floats from the start to the x of a node.
  std::size_t offset(std::size_t row, std::size_t column) const {
    return row * row_floats() + column % streams * components * pitch + column / streams;
  }
  std::size_t rest_offset(std::size_t row, std::size_t column) const {
    return row * rest_row_floats() + column % streams * 3 * pitch + column / streams;
  }
  /// Nodes of a stream that have a node of their row `right` columns further: springs that begin in it.
  std::size_t springs(std::size_t stream, std::size_t right) const {
    const std::size_t end = stream + right;
    return end < columns ? (columns - end - 1) / streams + 1 : 0;
  }
};

/// What the vector code needs to take small steps of a cloth.
struct QuarteredRows {
  QuarterLayout layout;
  AlignedArray nodes;  ///< [QuarterLayout::row_floats] for each row; padding is zero
  AlignedArray rest;   ///< [rows][streams][x y z][pitch] m, what x y z lack (carried_sum-inl.h)
  /// [1 + rows with pins][streams][pitch] 1 where a node may move, 0 for a pin and for padding.
  AlignedArray free;
  std::vector<const float*> free_of_row;  ///< [rows] into `free`; its start where the row has no pin

  /// By GridSpringKind, between free nodes and between a free one and a pin; divided by the mass of a node,
  /// so that what acts on a free end is its change of velocity.
  std::vector<Compliance<float>> of_free, of_pinned;
  float h_s = 0;   ///< the small step
  float fall = 0;  ///< m/s, of gravity in a small step
  float kept = 0;  ///< part of the velocity that the air leaves in a small step
  Surroundings surroundings{};
  std::size_t substeps = 1;  ///< in a step
  std::size_t threads = 1;
  std::size_t depth = 1;  ///< small steps that one pass over the cloth takes
  TeamGain team_gain;

  /// Throws Unsupported where the nodes differ in mass.
  QuarteredRows(const System& system, const GridPatch& grid, double dt_s, std::size_t lanes,
                std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
  bool has_pins(std::size_t row) const { return free_of_row[row] != free.data(); }
};

}  // namespace mssim
